#pragma once

#include <apsis/mesh/grid.hpp>
#include <apsis/velocity/velocity_set.hpp>

#include <utility>

namespace apsis {

/// A mesh times a set of velocities: where the unknowns f(x, v) live.
struct phase_space {
  grid mesh;                ///< cells in space
  velocity_set velocities;  ///< of every cell

  /// Both; without velocities for operators that do not ask for them.
  phase_space(const grid& cells, velocity_set of_every_cell = {})  // NOLINT(google-explicit-constructor)
      : mesh(cells), velocities(std::move(of_every_cell)) {}

  /// Number of unknowns.
  long points() const { return static_cast<long>(mesh.size()) * velocities.components(); }
};

}  // namespace apsis
