#pragma once

#include <apsis/mesh/grid.hpp>
#include <apsis/velocity/velocity_set.hpp>

#include <utility>

namespace apsis {

/// The product of a mesh and a set of velocities, on which unknowns f(x, v) are defined.
struct phase_space {
  grid mesh;                ///< cells in space
  velocity_set velocities;  ///< velocities in every cell

  /// Takes the mesh and its velocities. Operators that do not use velocities need none.
  phase_space(const grid& cells, velocity_set of_every_cell = {})  // NOLINT(google-explicit-constructor)
      : mesh(cells), velocities(std::move(of_every_cell)) {}

  /// Returns the number of unknowns.
  long points() const { return static_cast<long>(mesh.size()) * velocities.components(); }
};

}  // namespace apsis
