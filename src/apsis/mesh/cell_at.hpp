#pragma once

#include <apsis/mesh/grid.hpp>

#include <span>

namespace apsis {

/// Returns the cell that contains the point x of the domain, given by mesh.dimensions() coordinates. On a
/// face between two cells it is the upper one. Points outside belong to the nearest cell.
int cell_at(const grid& mesh, std::span<const double> x);

}  // namespace apsis
