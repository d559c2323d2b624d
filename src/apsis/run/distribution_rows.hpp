#pragma once

#include <apsis/output/solution.hpp>
#include <apsis/run/simulation.hpp>

namespace apsis {

/// Returns the unknowns of every stride-th cell in each direction (output.stride), or of those at chosen
/// points (output.distribution_at).
distribution_snapshot make_distribution_snapshot(const simulation& run);

/// Returns the unknowns of the cells that contain the points output.distribution_at, in their order, with the
/// centres of the cells multiplied by a unit of length. Between two cells the upper one counts.
distribution_at_points rows_at_points(const simulation& run, double unit_of_length);

}  // namespace apsis
