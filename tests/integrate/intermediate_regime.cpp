// Do O(ε) terms predicted from coefficients agree with the production stepper? The slow manifold of the
// linear problem u' = v, v' = (a u − v)/ε is known. Its slow eigenvalue is a − ε a² + O(ε²), with right
// eigenvector (1, a − ε a²) and left eigenvector (1, ε) up to O(ε²).
#include <apsis/method/intermediate_regime.hpp>

#include "support/catalogue.hpp"

#include <apsis/integrate/relaxation_problem.hpp>
#include <apsis/integrate/stepper.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

namespace intermediate_regime_test {

namespace {

using real = long double;
using state = std::array<real, 2>;
constexpr real a = 0.7L;

/// Returns the columns of the matrix of one step.
std::array<state, 2> columns_of_step(const std::string& name, real slope, real epsilon, real dt) {
  auto problem = apsis::make_relaxation_problem<state>(
      [](real, const state& u, state& out) { out = {u[1], 0}; }, [](const state& u) { return u[0]; },
      [slope](real w, state& out) { out = {w, slope * w}; }, [](real) { return real(1); }, epsilon);
  apsis::stepper march(apsis::find_method(name), problem);
  std::array<state, 2> columns{state{1, 0}, state{0, 1}};
  for (state& column : columns) march.step(0, dt, column);
  return columns;
}

/// Returns the maximum of (|Δu| + |Δv|)/(ε²/Δt + εΔt + Δt^p) at t = 1 for u' = v, v' = −(u + v)/ε from u
/// = 1. The maximum is over Δt = 1/16 … 1/4096 and ε from Δt/3 to 3·10⁻⁸ Δt. Initially v = 0, or v is on
/// the slow manifold.
real remainder_constant(const std::string& name, bool on_the_manifold) {
  const int order = apsis::find_method(name).claims.order;
  real largest = 0;
  for (int halvings = 4; halvings <= 12; ++halvings)
    for (int half_decades = 1; half_decades <= 15; ++half_decades) {
      const real dt = std::ldexp(real(1), -halvings),
                 epsilon = dt * std::pow(real(10), -half_decades / real(2));
      const real root = std::sqrt(1 - 4 * epsilon);
      const real slow = -2 / (1 + root), fast = -(1 + root) / (2 * epsilon), v0 = on_the_manifold ? slow : 0;
      const real c_fast = (v0 - slow) / (fast - slow), c_slow = 1 - c_fast;
      auto m = columns_of_step(name, -1, epsilon, dt);
      for (int k = 0; k < halvings; ++k) {  // repeated squaring of the matrix
        const auto [x, y] = m;
        m = {state{x[0] * x[0] + y[0] * x[1], x[1] * x[0] + y[1] * x[1]},
             state{x[0] * y[0] + y[0] * y[1], x[1] * y[0] + y[1] * y[1]}};
      }
      const real u = c_slow * std::exp(slow) + c_fast * std::exp(fast),
                 v = slow * c_slow * std::exp(slow) + fast * c_fast * std::exp(fast);
      const real error = std::abs(m[0][0] + v0 * m[1][0] - u) + std::abs(m[0][1] + v0 * m[1][1] - v);
      largest = std::max(largest, error / (epsilon * epsilon / dt + epsilon * dt + std::pow(dt, order)));
    }
  return largest;
}

struct slow_mode {
  real growth;  ///< logarithm of the slow eigenvalue over Δt
  real right;   ///< second component of the right eigenvector over the first
  real left;    ///< the same ratio of the left eigenvector
};

/// Computes the slow mode from the 2 × 2 matrix of one step.
slow_mode measure(const std::string& name, real epsilon, real dt) {
  const auto [x, y] = columns_of_step(name, a, epsilon, dt);
  const real trace = x[0] + y[1], determinant = x[0] * y[1] - y[0] * x[1];
  const real slow = trace / 2 + std::sqrt(trace * trace / 4 - determinant), fast = determinant / slow;
  // The matrix M − fast maps onto the right eigenvector of the slow mode, its transpose onto the left one.
  return {std::log(slow) / dt, x[1] / (x[0] - fast), y[0] / (x[0] - fast)};
}

class intermediate : public testing::TestWithParam<std::string> {};

TEST_P(intermediate, flux_last_stage_and_layer_agree_with_a_linear_problem) {
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
    EXPECT_GT(std::abs(shown.left), 1e-2L * dt);  // O(Δt), not O(ε)
  }
}

INSTANTIATE_TEST_SUITE_P(catalogue, intermediate, testing::ValuesIn(methods_with_an_intermediate_regime()),
                         test_name);

TEST(intermediate, remainders_have_the_documented_constants) {
  struct row {
    const char* name;
    double on_manifold, off_manifold;
  };
  // The constants are those of docs/plateaus.md, up to the two digits printed there.
  for (const row& r : {row{"md-imex-5-2", 0.72, 1.8}, row{"md-imex-plateau-free-12-2", 2.0, 2.0},
                       row{"md-imex-6-2-mixed", 0.95, 5.3}, row{"md-imex-8-3-mixed", 3.0, 9.6},
                       row{"md-imex-8-3", 5.6, 12.3}, row{"md-imex-6-3", 2154, 960}}) {
    EXPECT_NEAR(static_cast<double>(remainder_constant(r.name, true)), r.on_manifold, 0.03 * r.on_manifold)
        << r.name;
    EXPECT_NEAR(static_cast<double>(remainder_constant(r.name, false)), r.off_manifold, 0.03 * r.off_manifold)
        << r.name;
  }
}

}  // namespace

}  // namespace intermediate_regime_test
