#pragma once

#include <apsis/semidiscrete/problem_builder.hpp>

#include <vector>

namespace apsis {

/// Returns the numbers of all cells of the mesh, [cell][per_cell], from those of the blocks of all processes.
/// Collective; the result is on the root, elsewhere it is empty.
std::vector<double> gather_cells(const problem_builder& builder, std::vector<double> mine, int per_cell = 1);

/// The inverse of gather_cells(): returns the numbers of the cells of this process from those of all cells,
/// which the root gives. Collective.
std::vector<double> scatter_cells(const problem_builder& builder, std::vector<double> all, int per_cell = 1);

}  // namespace apsis
