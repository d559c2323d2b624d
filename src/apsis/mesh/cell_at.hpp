#pragma once

#include <apsis/mesh/grid.hpp>

#include <span>

namespace apsis {

/// Returns the cell that contains a point of the domain; of two, the upper one.
int cell_at(const grid& mesh, std::span<const double> x);

}  // namespace apsis
