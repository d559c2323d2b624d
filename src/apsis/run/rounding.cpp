#include <apsis/run/rounding.hpp>

#include <apsis/method/linear_formula.hpp>
#include <apsis/run/setup.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace apsis {
namespace {

constexpr double unit_roundoff = 0.5 * std::numeric_limits<double>::epsilon();

/// Returns √L for a moment of n numbers. Rows of velocities are summed in chains of at most 64 numbers and 16
/// lines, then pairwise. Shorter rows of other models are summed sequentially.
double root_of_chain(int n) {
  constexpr double longest = 64.0 + 16.0;
  const double numbers = std::max(n, 1);
  return std::sqrt(std::min(numbers, longest + std::log2(numbers)));
}

}  // namespace

rounding_bound rounding_of(const shu_osher_form<double>& m, const model& equation) {
  const double of_moments = root_of_chain(equation.components());
  const auto* relaxation = equation.as_relaxation();
  const double of_target = relaxation != nullptr ? relaxation->moment_accuracy() / unit_roundoff : 4.0;
  const double of_collision = of_target + of_moments;
  const auto initial = initial_weights(m);
  std::vector<double> error(m.stages(), 0.0);
  for (std::size_t i = 0; i < m.stages(); ++i) {
    double carried = 0.0, weights = std::abs(initial[i]), terms = initial[i] != 0.0 ? 1.0 : 0.0;
    double collisions = m.D(i, i) != 0.0 || m.ddot[i] != 0.0 ? 1.0 : 0.0;
    for (std::size_t j = 0; j < i; ++j) {
      const double weight = std::abs(m.P(i, j)) + std::abs(m.W(i, j));
      carried += weight * error[j];
      weights += weight;
      if (weight != 0.0) ++terms;
      if (m.D(i, j) != 0.0) ++collisions;
    }
    error[i] = carried + unit_roundoff * weights * (2.0 + std::sqrt(terms) + collisions * of_collision);
  }
  // With unknowns of both signs, the terms of a sum may exceed the scale of its bound.
  const double cancellation = equation.positive() && equation.why_signed().empty() ? 1.0 : 1024.0;
  return {2.0 * cancellation * unit_roundoff * (2.0 + of_moments), error.empty() ? 0.0 : error.back()};
}

rounding_bound rounding_of(const run_setup& setup) {
  const time_integrator& m = setup.integrator();
  const rounding_bound of_first_steps = rounding_of(m.starter().coefficients<double>(), *setup.equation),
                       later = rounding_of(m.form, *setup.equation);
  return {later.of_sums, error_amplification(m.weights) * std::max(of_first_steps.of_step, later.of_step)};
}

}  // namespace apsis
