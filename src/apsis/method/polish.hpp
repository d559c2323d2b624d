#pragma once

#include <apsis/method/method.hpp>
#include <apsis/method/precision.hpp>

#include <functional>
#include <vector>

namespace apsis {

/// Result of polish().
struct polish_result {
  method polished;                 ///< the method with coefficients of `digits` decimals
  mp_real residual;                ///< largest residual of its order conditions
  mp_real largest_move;            ///< largest change of a coefficient
  mp_real smallest_possible_move;  ///< lower bound of largest_move for any method with these zeros (linear
                                   ///< duality; moves are ~1e-15)
};

/// Additional equations for polish(), returned as residuals, for example those of the intermediate regime.
using polish_conditions = std::function<std::vector<mp_real>(const shu_osher_form<mp_real>&)>;

/// Returns the method closest to `m` that satisfies its order conditions to `digits` decimals, by Newton's
/// method with minimal change in 60 digits. It preserves every zero, every exact rational and every row
/// without weight on u^n. Third-order IMEX conditions are singular at a solution, because together they imply
/// Σ b̂_i (c_i − ĉ_i)² = 0 with b̂ ≥ 0. Therefore c = ĉ is imposed at every stage whose T contributes, and
/// dependent equations are dropped. Throws numerical_error if the iteration does not converge, input_error
/// for methods with exact collisions.
polish_result polish(const method& m, int digits = 45, const polish_conditions& conditions = {});

}  // namespace apsis
