// The terms of size ε that the coefficients predict, against the production stepper on a linear problem whose
// slow manifold is known: u' = v, v' = (a u − v)/ε. Its slow eigenvalue is a − ε a² + O(ε²), with the right
// eigenvector (1, a − ε a²) and the left eigenvector (1, ε) up to O(ε²).
#include <apsis/method/intermediate_regime.hpp>

#include "support/catalogue.hpp"

#include <apsis/integrate/relaxation_problem.hpp>
#include <apsis/integrate/stepper.hpp>

#include <array>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

namespace {

using real = long double;
using state = std::array<real, 2>;
constexpr real a = 0.7L;

struct slow_mode {
  real growth;  ///< logarithm of the eigenvalue over Δt
  real right;   ///< second component of the right eigenvector over the first
  real left;    ///< of the left eigenvector
};

/// From the 2 × 2 matrix of one step.
slow_mode measure(const std::string& name, real epsilon, real dt) {
  auto problem = apsis::make_relaxation_problem<state>(
      [](real, const state& u, state& out) { out = {u[1], 0}; }, [](const state& u) { return u[0]; },
      [](real w, state& out) { out = {w, a * w}; }, [](real) { return real(1); }, epsilon);
  apsis::stepper march(apsis::find_method(name), problem);
  state x{1, 0}, y{0, 1};
  march.step(0, dt, x);
  march.step(0, dt, y);
  const real trace = x[0] + y[1], determinant = x[0] * y[1] - y[0] * x[1];
  const real slow = trace / 2 + std::sqrt(trace * trace / 4 - determinant), fast = determinant / slow;
  // (M − fast) maps onto the slow eigenvector, (M − fast)ᵀ onto the left one.
  return {std::log(slow) / dt, x[1] / (x[0] - fast), y[0] / (x[0] - fast)};
}

class intermediate : public testing::TestWithParam<std::string> {};

TEST_P(intermediate, flux_last_stage_and_layer_are_what_a_linear_problem_shows) {
  const auto& m = apsis::find_method(GetParam());
  const auto predicted = apsis::analyse_intermediate_regime(m.coefficients<real>());
  const real epsilon = 1e-10L, dt = 1e-4L;  // ε/Δt = 1e-6, and terms ε Δt of relative size 1e-4
  const auto limit = measure(m.name, 0, dt), shown = measure(m.name, epsilon, dt);
  const auto as_predicted = [&](real value, real of_method) {
    EXPECT_NEAR(static_cast<double>(value), static_cast<double>(of_method),
                2e-3 * (1 + std::abs(static_cast<double>(of_method))));
  };
  as_predicted((limit.growth - shown.growth) / (epsilon * a * a), predicted.flux);
  as_predicted((a - shown.right) / (epsilon * a * a), predicted.last);
  if (std::isfinite(predicted.layer)) {
    as_predicted(shown.left / epsilon, predicted.layer);
  } else {
    EXPECT_GT(std::abs(shown.left), 1e-2L * dt);  // of size Δt, not ε
  }
}

INSTANTIATE_TEST_SUITE_P(catalogue, intermediate, testing::ValuesIn(methods_with_an_intermediate_regime()),
                         test_name);

}  // namespace
