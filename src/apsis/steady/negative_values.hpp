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

/// Makes all rows of `cells` nonnegative. Their moments ω = ℛf change only by rounding. A row becomes
/// max(f, 0)(1 + Σ_i a_i W_i) with the ω of f. W_i are the functions of the moments: ω_i = Σ_k W_ik f_k. For
/// a gas the factor is 1 + α + β·c + γ|c|². If it is negative somewhere, the row becomes f + θ(E(ω) − f) with
/// the smallest θ ∈ [0, 1]. Throws numerical_error with the number of the cell in the whole mesh of `space`
/// if ω has no equilibrium. Dimensionless.
removed_values remove_negative_values(const relaxation_model& equation, const domain& space,
                                      const std::vector<int>& cells, field& f);

}  // namespace apsis
