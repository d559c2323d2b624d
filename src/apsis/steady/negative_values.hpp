#pragma once

#include <apsis/mesh/field.hpp>
#include <apsis/model/model.hpp>

#include <cstdint>
#include <vector>

namespace apsis {

/// The values that remove_negative_values() removed.
struct removed_values {
  std::int64_t count = 0;  ///< negative values
  double lowest = 0.0;     ///< the smallest of them
};

/// Makes all rows of `cells` nonnegative. Their moments ω = ℛf change by rounding alone. A row of a gas
/// becomes max(f, 0)(1 + α + β·c + γ|c|²) with the ω of f, or where that is negative too, and for other
/// models, f + θ(E(ω) − f) with the least θ ∈ [0, 1]. Throws numerical_error for a cell where ω has no
/// equilibrium, with its number on this process. Dimensionless.
removed_values remove_negative_values(const relaxation_model& equation, const std::vector<int>& cells,
                                      field& f);

}  // namespace apsis
