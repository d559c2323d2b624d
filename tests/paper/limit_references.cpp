// References of the limit scheme: limit systems written out by hand, their smooth solutions, and the exact
// Riemann solution of the Broadwell limit.
#include <apsis/core/errors.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <boost/math/quadrature/gauss.hpp>
#include <boost/math/quadrature/tanh_sinh.hpp>
#include <paper/broadwell_riemann.hpp>
#include <paper/fourier_solution.hpp>
#include <support/property.hpp>

namespace limit_references_test {

using namespace apsis;
using namespace apsis::paper;
using std::numbers::pi;

namespace {

const limit_equations burgers = {
    "Burgers", 1, [](const double* u, double* f) { f[0] = 0.5 * u[0] * u[0]; }, {}};

/// Returns the solution u = g(x − ut) of Burgers' equation on characteristics, by bisection. g is nowhere
/// steep enough for a shock.
double burgers_exact(double x, double t) {
  double low = 0.0, high = 1.0;
  for (int k = 0; k < 100; ++k) {
    const double u = 0.5 * (low + high);
    (u < 0.5 + 0.25 * std::sin(pi * (x - u * t)) ? low : high) = u;
  }
  return low;
}

fourier_solution solve_burgers(int points, int steps) {
  return {
      burgers, 0.0,  2.0, points, [](double x, std::span<double> u) { u[0] = 0.5 + 0.25 * std::sin(pi * x); },
      0.4,     steps};
}

broadwell_riemann::state conserved_flux(broadwell_riemann::state w) {
  return {w.m, (w.rho * w.rho + w.m * w.m) / (2.0 * w.rho)};
}

/// Returns the integral of the solution at t = 1 over −1 < x < 1, piece by piece.
broadwell_riemann::state integral(const broadwell_riemann& solution) {
  std::array<double, 6> ends = {-1.0,
                                solution.slow_wave()[0],
                                solution.slow_wave()[1],
                                solution.fast_wave()[0],
                                solution.fast_wave()[1],
                                1.0};
  broadwell_riemann::state sum{0.0, 0.0};
  // The solution is nearly singular only at the ends of pieces: at λ = ±1, where u = ±1. The tolerance of the
  // rule is that of the refinement before the last. With the default, the square root of the machine epsilon,
  // one state in thousands has an error of 1e-9.
  boost::math::quadrature::tanh_sinh<double> rule;
  constexpr double tolerance = 1e-12;
  for (std::size_t k = 0; k + 1 < ends.size(); ++k) {
    const double a = ends[k], b = ends[k + 1];
    if (!(b > a)) continue;
    sum.rho += rule.integrate([&](double x) { return solution.at(x).rho; }, a, b, tolerance);
    sum.m += rule.integrate([&](double x) { return solution.at(x).m; }, a, b, tolerance);
  }
  return sum;
}

}  // namespace

TEST(fourier_solution, is_exact_for_burgers_equation_before_the_shock) {
  const auto solution = solve_burgers(129, 1000);
  const double h = 0.1;
  for (const double x : {0.03, 0.5, 1.1, 1.97}) {
    // The tolerance covers the rounding errors of 1000 steps. The neglected modes are smaller.
    EXPECT_NEAR(solution.value(0, x), burgers_exact(x, 0.4), 2e-13);
    const double mean = boost::math::quadrature::gauss<double, 15>::integrate(
                            [](double y) { return burgers_exact(y, 0.4); }, x - 0.5 * h, x + 0.5 * h) /
                        h;
    EXPECT_NEAR(solution.average(0, x, h), mean, 2e-13);
  }
  EXPECT_LT(solution.resolution(), 1e-13);
}

TEST(fourier_solution, says_when_it_does_not_resolve) {
  EXPECT_GT(solve_burgers(9, 100).resolution(), 1e-4);
  EXPECT_THROW(solve_burgers(8, 100), input_error);
}

TEST(fourier_solution, integrates_systems_without_space) {
  case_config config = load_case("paper/ode");
  const fourier_solution solution(
      *written_limit(config), 0.0, 1.0, 1, [](double, std::span<double> u) { u[0] = 2.0; }, 1.0, 2000);
  EXPECT_NEAR(solution.value(0, 0.0), 2.0 * std::atan(std::tan(1.0) * std::numbers::e), 1e-13);
}

TEST(broadwell_riemann, solves_the_problem_made_of_one_shock) {
  const broadwell_riemann::state left{2.0, 1.0}, right{1.0, 0.13962};
  const broadwell_riemann solution(left, right);
  // The published data have five decimals, so a slow wave of that size remains.
  EXPECT_NEAR(solution.middle().rho, 2.0, 1e-5);
  EXPECT_NEAR(solution.middle().m, 1.0, 1e-5);
  EXPECT_NEAR(solution.fast_wave()[0], 1.0 - 0.13962, 1e-5);
  EXPECT_EQ(solution.fast_wave()[0], solution.fast_wave()[1]);
}

TEST(broadwell_riemann, conserves_and_orders_its_waves_for_random_states) {
  check_property("integral over x at t = 1 is what flowed in", [] {
    const auto number = [](double a, double b) { return a + (b - a) * 1e-4 * *rc::gen::inRange(0, 10001); };
    const auto draw = [&] {
      const double rho = std::pow(10.0, number(-2.0, 2.0));
      return broadwell_riemann::state{rho, rho * number(-0.99, 0.99)};
    };
    const auto left = draw(), right = draw();
    const broadwell_riemann solution(left, right);
    const auto slow = solution.slow_wave(), fast = solution.fast_wave();
    RC_ASSERT(-1.0 < slow[0] && slow[0] <= slow[1] && slow[1] < fast[0] && fast[0] <= fast[1] &&
              fast[1] < 1.0);
    const auto total = integral(solution);
    const auto in = conserved_flux(left), out = conserved_flux(right);
    // The solution is a weak solution on a box. The tolerance is relative to the largest density.
    const double tolerance = 1e-11 * std::max({left.rho, right.rho, solution.middle().rho});
    RC_ASSERT(std::abs(total.rho - (left.rho + right.rho + in.rho - out.rho)) < tolerance);
    RC_ASSERT(std::abs(total.m - (left.m + right.m + in.m - out.m)) < tolerance);
  });
}

TEST(broadwell_riemann, returns_constant_states_and_mirrors) {
  const broadwell_riemann constant({1.5, 0.3}, {1.5, 0.3});
  for (const double s : {-0.9, -0.1, 0.2, 0.9}) EXPECT_NEAR(constant.at(s).rho, 1.5, 1e-14);
  const broadwell_riemann there({1.0, 0.2}, {0.3, -0.1}), back({0.3, 0.1}, {1.0, -0.2});
  for (const double s : {-0.8, -0.33, 0.11, 0.77}) {
    EXPECT_NEAR(there.at(s).rho, back.at(-s).rho, 1e-13);
    EXPECT_NEAR(there.at(s).m, -back.at(-s).m, 1e-13);
  }
}

TEST(broadwell_riemann, refuses_states_that_are_not_hyperbolic) {
  EXPECT_THROW(broadwell_riemann({1.0, 1.0}, {1.0, 0.0}), input_error);
  EXPECT_THROW(broadwell_riemann({1.0, 0.0}, {0.0, 0.0}), input_error);
  EXPECT_THROW(broadwell_riemann({1.0, 0.0}, {std::nan(""), 0.0}), input_error);
}

}  // namespace limit_references_test
