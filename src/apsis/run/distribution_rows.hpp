#pragma once

#include <apsis/output/solution.hpp>
#include <apsis/run/simulation.hpp>

#include <optional>

namespace apsis {

/// Returns the part of the mesh that this process owns; nothing if it is the only process.
std::optional<dataset_part> part_of(const simulation& run);

/// Returns the cells of a block as a part of its mesh.
dataset_part part_of(const grid& block);

/// Returns the unknowns of every stride-th cell in each direction (output.stride), or of the cells at
/// chosen points (output.distribution_at). Collective: every process returns its own cells, the root alone
/// the cells at points.
distribution_snapshot make_distribution_snapshot(const simulation& run);

/// Returns the unknowns of the cells that contain the points output.distribution_at, in the order of the
/// points. Also returns the centres of these cells, multiplied by a unit of length. A point between two cells
/// belongs to the upper one. Collective; the unknowns are on the root.
distribution_at_points rows_at_points(const simulation& run, double unit_of_length);

}  // namespace apsis
