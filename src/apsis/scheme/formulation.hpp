#pragma once

namespace apsis {

/// Meaning of the unknowns of a cell.
enum class formulation {
  finite_volume,     ///< cell averages
  finite_difference  ///< point values at cell centres
};

/// Points at which cell averages collide.
enum class collision_points {
  gauss,   ///< three Gauss–Legendre points of every cell, on the reconstruction of its stage
  centres  ///< the centres of the cells, mapped to averages by all of them together
};

}  // namespace apsis
