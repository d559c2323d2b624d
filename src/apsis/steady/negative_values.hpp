#pragma once

#include <apsis/boundary/domain.hpp>
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

/// Makes all rows of `cells` nonnegative. Their moments ω = ℛf change only by rounding. A row of a gas
/// becomes max(f, 0)(1 + α + β·c + γ|c|²) with the ω of f. If this is negative too, and for other models, the
/// row becomes f + θ(E(ω) − f) with the smallest θ ∈ [0, 1]. Throws numerical_error with the number of the
/// cell in the whole mesh of `space` if ω has no equilibrium. Dimensionless.
removed_values remove_negative_values(const relaxation_model& equation, const domain& space,
                                      const std::vector<int>& cells, field& f);

}  // namespace apsis
