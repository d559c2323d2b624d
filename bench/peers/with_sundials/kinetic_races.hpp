#pragma once

#include "measure/table.hpp"

#include <vector>

namespace apsis::bench::peers {

/// Unknowns of the discretization in space.
enum class unknowns {
  averages,  ///< cell averages, finite volumes: the collision is evaluated at Gauss points (paper/bgk-mixed)
  averages_at_centres,  ///< cell averages, with collisions at the centres of cells
  points                ///< point values, finite differences: the collision is pointwise (paper/bgk-mixed-fd)
};

/// Measures work and precision on the mixed-regime problem of the paper with these unknowns, for the given
/// temporal errors.
result_table race_on_mixed_regime(unknowns which, const std::vector<double>& errors, const settings& options);

/// Measures work and precision on Broadwell's model with smooth data out of equilibrium (paper/broadwell), on
/// point values, for ε = 1, 1e-2, 1e-4 and 1e-6.
result_table race_on_broadwell(const settings& options);

}  // namespace apsis::bench::peers
