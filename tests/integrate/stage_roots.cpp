// Stage equations with second derivatives have several roots: for u' = (w − u²)/ε, w' = −u' also one near
// u = −1/2, where G' vanishes. Stages lead to the root of short steps.
#include "support/catalogue.hpp"

#include <apsis/integrate/error_control.hpp>
#include <apsis/integrate/integrate.hpp>
#include <apsis/integrate/newton_problem.hpp>
#include <apsis/integrate/sparsity_pattern.hpp>
#include <apsis/method/method.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace stage_roots_test {
namespace {

using row = std::vector<double>;

/// Pairs (u, w) of any number, each with u' = (w − u²)/ε and w' = −u'.
struct exchanges {
  double epsilon;
  template <class Numbers, class Out>
  void operator()(const Numbers& v, Out& out) const {
    for (std::size_t i = 0; i < v.size(); i += 2) {
      out[i] = (v[i + 1] - v[i] * v[i]) / epsilon;
      out[i + 1] = -out[i];
    }
  }
};

/// The positive root of u² + u = sum.
double equilibrium(double sum) {
  return (-1.0 + std::sqrt(1.0 + 4.0 * sum)) / 2.0;
}

std::vector<std::string> methods_with_second_derivatives() {
  return methods_where([](const apsis::method& m) {
    const auto& ddot = m.exact.ddot;
    return !apsis::solves_exactly(m.kind) &&
           std::any_of(ddot.begin(), ddot.end(), [](const std::string& x) { return x != "0"; });
  });
}

/// The start has u = 0, where R' is negative for long steps, and other values at both sides of it.
const row starts = {0.0, 1.0, 1e-3, 0.5, 0.1, 2.0, 1.5, 0.0, 0.3, 0.0};

class every_stage : public testing::TestWithParam<std::string> {};

TEST_P(every_stage, leads_to_the_equilibrium_that_short_steps_reach) {
  const apsis::method& m = apsis::find_method(GetParam());
  for (const double epsilon : {3e-2, 1e-2, 1e-3, 3e-4, 1e-5, 1e-8}) {
    row u = starts;
    apsis::newton_problem problem{apsis::no_transport{}, exchanges{epsilon}};
    apsis::stepper march(m, problem);
    // The slowest deviation decays in 3 ε. After a time of 40, it is below rounding errors for exact stages,
    // and methods that are not L-stable damp it by at least a tenth in each of the 160 steps.
    apsis::integrate(march, u, 0.0, 40.0, apsis::step_rule<double>::fixed(0.25));
    for (std::size_t i = 0; i < u.size(); i += 2) {
      const double sum = starts[i] + starts[i + 1];
      EXPECT_NEAR(u[i], equilibrium(sum), 1e-9) << epsilon << " from " << starts[i];
      EXPECT_NEAR(u[i] + u[i + 1], sum, 1e-12) << epsilon;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(with_second_derivatives, every_stage,
                         testing::ValuesIn(methods_with_second_derivatives()), [](const auto& of) {
                           std::string name = of.param;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

TEST(stage_roots, do_not_depend_on_the_linear_solver) {
  const double dt = 0.25, epsilon = 1e-3;
  row expected = starts;
  apsis::newton_problem{apsis::no_transport{}, exchanges{epsilon}}.solve_collision(0.0, dt, -dt * dt / 2.0,
                                                                                   expected);
  row of_krylov = starts, of_sparse = starts;
  apsis::newton_problem{apsis::no_transport{}, exchanges{epsilon}, {apsis::linear_solver::krylov}}
      .solve_collision(0.0, dt, -dt * dt / 2.0, of_krylov);
  std::vector<std::pair<std::size_t, std::size_t>> entries;
  for (std::size_t i = 0; i < starts.size(); ++i) {
    entries.emplace_back(i, i);
    entries.emplace_back(i, i ^ 1);
  }
  apsis::newton_problem{apsis::no_transport{}, exchanges{epsilon}}
      .with_sparsity(apsis::sparsity_pattern(starts.size(), entries))
      .solve_collision(0.0, dt, -dt * dt / 2.0, of_sparse);
  for (std::size_t i = 0; i < starts.size(); ++i) {
    EXPECT_GT(expected[i], 0.0) << i;
    EXPECT_NEAR(of_krylov[i], expected[i], 1e-9) << i;  // GMRES solves to the rounding of terms (dt/ε)² ≈ 6e4
    EXPECT_NEAR(of_sparse[i], expected[i], 1e-12) << i;
  }
}

}  // namespace
}  // namespace stage_roots_test
