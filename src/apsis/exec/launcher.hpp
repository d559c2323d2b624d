#pragma once

namespace apsis {

/// Returns the number of processes that a launcher (Open MPI, MPICH, Slurm with PMI) started, as it states it
/// in the environment; 1 without a launcher.
int launched_count();

/// Returns the rank of this process among them; 0 without a launcher.
int launched_rank();

}  // namespace apsis
