#pragma once

#include <apsis/method/method.hpp>
#include <apsis/method/precision.hpp>

#include <functional>
#include <vector>

namespace apsis {

/// What polishing did.
struct polish_result {
  method polished;                 ///< the same method with `digits` decimals
  mp_real residual;                ///< largest residual of its order conditions
  mp_real largest_move;            ///< largest change of a coefficient
  mp_real smallest_possible_move;  ///< no method with these zeros lies nearer (linear duality; the moves are
                                   ///< ~1e-15)
};

/// Further equations for polish(), by what is missing to zero, for example those of the intermediate regime.
using polish_conditions = std::function<std::vector<mp_real>(const shu_osher_form<mp_real>&)>;

/// The method nearest to `m` that satisfies its order conditions to `digits` decimals: Newton's method with
/// the least change, in 60 digits, keeping every zero, every exact rational and every row that leaves nothing
/// for u^n. Third-order IMEX conditions are singular at a solution, because together they say Σ b̂_i (c_i −
/// ĉ_i)² = 0 with b̂ ≥ 0; so c = ĉ at every stage whose T counts is imposed instead, and equations that depend
/// on others are left out. Throws numerical_error if it does not converge.
polish_result polish(const method& m, int digits = 45, const polish_conditions& conditions = {});

}  // namespace apsis
