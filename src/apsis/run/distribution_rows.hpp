#pragma once

#include <apsis/output/solution.hpp>
#include <apsis/run/simulation.hpp>

#include <optional>

namespace apsis {

/// Returns the part of the mesh that this process holds; nothing if it holds all.
std::optional<dataset_part> part_of(const simulation& run);

/// Returns the cells of a block as a part of its mesh.
dataset_part part_of(const grid& block);

/// Returns the unknowns of every stride-th cell in each direction (output.stride), or of those at chosen
/// points (output.distribution_at). Collective; the cells are those of this process, the points are on the
/// root.
distribution_snapshot make_distribution_snapshot(const simulation& run);

/// Returns the unknowns of the cells that contain the points output.distribution_at, in their order, with the
/// centres of the cells multiplied by a unit of length. Between two cells the upper one counts. Collective;
/// the unknowns are on the root.
distribution_at_points rows_at_points(const simulation& run, double unit_of_length);

}  // namespace apsis
