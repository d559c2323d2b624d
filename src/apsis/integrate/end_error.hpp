#pragma once

#include <apsis/core/errors.hpp>

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <utility>

#include <fmt/format.h>

namespace apsis {

/// A solution whose error at the end was estimated.
template <class Solution>
struct refined_solution {
  Solution solution;  ///< of the last run
  double factor,      ///< its tolerances are those wanted times this
      error;          ///< its estimated error, in units of the tolerances wanted
  int runs;           ///< number of integrations
};

/// Integrates until the error of the result, and not only that of each step, is within the tolerances.
/// Errors of steps add up, for example in oscillations without damping.
///
///   solve(factor)             integrates with all tolerances multiplied by `factor` ≤ 1
///   difference(coarse, fine)  the size of the difference of two results, in units of the tolerances wanted
///
/// Each run has tolerances at most a tenth of those before. With results u₁ and u₂ of the tolerances f₁ > f₂,
/// the error of u₂ is at most |u₁ − u₂| q/(1 − q), q = √(f₂/f₁), if errors decrease at least as the root of
/// the tolerance. Usually they decrease in proportion to it.
///
/// Throws numerical_error if the error is not within the tolerances after `most_runs` runs or above the
/// factor `least`: then results depend on the tolerances too much, as chaotic ones do. Throws what solve()
/// throws.
template <class Solve, class Difference>
refined_solution<std::invoke_result_t<Solve&, double>> refine_until_accurate(Solve&& solve,
                                                                             Difference&& difference,
                                                                             double least = 1e-9,
                                                                             int most_runs = 8) {
  constexpr double next = 0.1, longest = 1e-3;
  double factor = 1.0, error = 0.0;
  auto coarse = solve(factor);
  for (int runs = 2; runs <= most_runs; ++runs) {
    const double shrink = runs == 2 ? next : std::clamp(0.5 / error, longest, next);
    factor *= shrink;
    if (!(factor >= least)) break;  // also NaN
    auto fine = solve(factor);
    const double q = std::sqrt(shrink);
    error = difference(std::as_const(coarse), std::as_const(fine)) * q / (1.0 - q);
    if (error <= 1.0) return {std::move(fine), factor, error, runs};
    coarse = std::move(fine);
  }
  throw numerical_error(fmt::format(
      "the error at the end is not within the tolerances (it is {:.3g} times as large, after runs with "
      "tolerances down to {:.1e} of those wanted); enlarge the tolerances, or end earlier",
      error, factor));
}

}  // namespace apsis
