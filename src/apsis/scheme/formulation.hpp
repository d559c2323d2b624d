#pragma once

namespace apsis {

/// What the unknowns of a cell are.
enum class formulation {
  finite_volume,     ///< averages over the cell
  finite_difference  ///< values at its centre
};

}  // namespace apsis
