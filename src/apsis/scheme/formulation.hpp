#pragma once

namespace apsis {

/// Meaning of the unknowns of a cell.
enum class formulation {
  finite_volume,     ///< cell averages
  finite_difference  ///< point values at cell centres
};

}  // namespace apsis
