#pragma once

namespace apsis {

/// Returns the number of started processes that a launcher (Open MPI, MPICH, Slurm with PMI) states in the
/// environment; 1 without a launcher.
int launched_count();

/// Returns the rank of this process among the started ones; 0 without a launcher.
int launched_rank();

}  // namespace apsis
