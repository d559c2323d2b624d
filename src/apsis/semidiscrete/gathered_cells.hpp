#pragma once

#include <apsis/semidiscrete/problem_builder.hpp>

#include <vector>

namespace apsis {

/// Returns the numbers of all cells of the mesh, [cell][per_cell], from those of the blocks of all processes.
/// Collective; the result is empty except on the root.
std::vector<double> gather_cells(const problem_builder& builder, std::vector<double> mine, int per_cell = 1);

/// The inverse of gather_cells(): returns the numbers of the cells of this process from those of all cells on
/// the root. Collective.
std::vector<double> scatter_cells(const problem_builder& builder, std::vector<double> all, int per_cell = 1);

}  // namespace apsis
