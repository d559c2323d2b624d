// Collisions that depend on time: derivatives along the flow, and the order of every kind of method.
#include <apsis/integrate/any_stepper.hpp>
#include <apsis/integrate/autodiff.hpp>
#include <apsis/integrate/error_control.hpp>
#include <apsis/integrate/newton_problem.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <integrate/random.hpp>
#include <support/property.hpp>

namespace timed_collision_test {
namespace {

using apsis::find_integrator;
using apsis::newton_problem;
using apsis::no_transport;
using random_input::uniform;
using row = std::vector<double>;

/// u₁' = −(u₁ − sin t)³ − (u₁ − sin t) + cos t,  u₂' = u₁ cos(3t) − u₂ sin t.
constexpr auto driven = [](const auto& t, const auto& u, auto& out) {
  using std::sin, std::cos;
  const auto off = u[0] - sin(t);
  out[0] = cos(t) - off * off * off - off;
  out[1] = u[0] * cos(3.0 * t) - u[1] * sin(t);
};

/// The same equation with time as third unknown.
constexpr auto autonomous = [](const auto& u, auto& out) {
  using std::sin, std::cos;
  const auto off = u[0] - sin(u[2]);
  out[0] = cos(u[2]) - off * off * off - off;
  out[1] = u[0] * cos(3.0 * u[2]) - u[1] * sin(u[2]);
  out[2] = 1.0 + 0.0 * u[0];
};

TEST(timed_collision, derivatives_are_those_of_time_as_an_unknown) {
  check_property("random time, point and direction", [] {
    apsis::vector_field<double, decltype(driven)> field(driven);
    apsis::vector_field<double, decltype(autonomous)> with_time(autonomous);
    const double t = uniform(-2, 2);
    const row u{uniform(-1, 1), uniform(-1, 1)}, x{uniform(-1, 1), uniform(-1, 1)},
        k{uniform(-1, 1), uniform(-1, 1)};
    const row u3{u[0], u[1], t}, x3{x[0], x[1], 0}, k3{k[0], k[1], 1};
    row g(2), g_dot(2), jx(2), kx(2), hx(2), g3(3), g_dot3(3), jx3(3), kx3(3), hx3(3);
    field.set_time(t, 1);
    field.time_derivatives(u, g, g_dot);
    with_time.time_derivatives(u3, g3, g_dot3);
    field.second_product(u, x, jx, kx);
    with_time.second_product(u3, x3, jx3, kx3);
    for (std::size_t i = 0; i < 2; ++i) {
      // The tolerances cover a dozen roundings of numbers below 100.
      RC_ASSERT(std::abs(g[i] - g3[i]) <= 1e-13 && std::abs(g_dot[i] - g_dot3[i]) <= 1e-13);
      RC_ASSERT(std::abs(jx[i] - jx3[i]) <= 1e-13 && std::abs(kx[i] - kx3[i]) <= 1e-12);
    }
    field.curvature(u, k, x, jx, hx);
    with_time.curvature(u3, k3, x3, jx3, hx3);
    for (std::size_t i = 0; i < 2; ++i) RC_ASSERT(std::abs(hx[i] - hx3[i]) <= 1e-12);
  });
}

TEST(timed_collision, a_stage_is_that_of_time_as_an_unknown) {
  newton_problem problem(no_transport{}, driven);
  newton_problem with_time(no_transport{}, autonomous);
  const double t = 0.4, a = 0.3, b = -0.05;
  row u{0.5, -0.2}, v{0.5, -0.2, t - a};  // the time of the stage is t = (t − a) + a · 1
  problem.solve_timed_collision(t, a, b, u);
  with_time.solve_collision(0, a, b, v);
  EXPECT_NEAR(v[2], t, 1e-15);
  for (std::size_t i = 0; i < 2; ++i) EXPECT_NEAR(u[i], v[i], 1e-14);
}

/// Returns the solution at t = 1 after equal steps from t = 0.
template <class P>
row end_of(const std::string& method, P& problem, long steps, row u) {
  apsis::with_stepper(find_integrator(method), problem, [&](auto march) {
    apsis::integrate(march, u, 0.0, 1.0, apsis::step_rule<double>::fixed(1.0 / static_cast<double>(steps)));
  });
  return u;
}

double distance(const row& u, const row& v) {
  return std::max(std::abs(u[0] - v[0]), std::abs(u[1] - v[1]));
}

class methods_without_transport : public ::testing::TestWithParam<std::pair<std::string, int>> {};

TEST_P(methods_without_transport, have_their_order_for_g_of_time) {
  const auto& [name, order] = GetParam();
  newton_problem problem(no_transport{}, driven);
  newton_problem with_time(no_transport{}, autonomous);
  // The reference is an explicit method of order 8 with time as an unknown. It uses no code for G of time.
  const row exact = end_of("dop853", with_time, 400, {0.5, 1, 0});
  const double coarse = distance(end_of(name, problem, 20, {0.5, 1}), exact),
               fine = distance(end_of(name, problem, 40, {0.5, 1}), exact);
  EXPECT_GT(std::log2(coarse / fine), order - 0.35) << coarse << " " << fine;
}

// Implicit methods integrate time as part of Q, with ∂Q/∂t in Q̇. The others integrate it as part of T. The
// values are names and orders.
INSTANTIATE_TEST_SUITE_P(timed_collision, methods_without_transport,
                         ::testing::Values(std::pair{"imdrk-1-2", 2}, std::pair{"imdrk-3-3", 3},
                                           std::pair{"imdrk-7-4", 4}, std::pair{"imdrk-9-5", 5},
                                           std::pair{"imdrk-9-5-accurate", 5}, std::pair{"dirk-4-3", 4},
                                           std::pair{"md-imex-6-3", 3},
                                           std::pair{"md-imex-16-4-efficient", 4}, std::pair{"ark-436", 4},
                                           std::pair{"extrapolated-euler-4", 4}, std::pair{"kutta-4", 4},
                                           std::pair{"imex-bdf-3", 3}, std::pair{"imex-dimsim-3", 3},
                                           std::pair{"imdrk-2-4", 4}, std::pair{"two-step-10-3-mixed", 3}),
                         [](const auto& test) {
                           std::string name = test.param.first;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

TEST(timed_collision, transport_and_collision_may_both_depend_on_time) {
  const auto f = [](double t, const row& u, row& out) { out = {std::cos(t) * u[1], -u[0]}; };
  const auto sum = [](const auto& u, auto& out) {
    using std::cos;
    autonomous(u, out);
    out[0] += cos(u[2]) * u[1];
    out[1] -= u[0];
  };
  newton_problem problem(f, driven);
  newton_problem with_time(no_transport{}, sum);
  const row exact = end_of("dop853", with_time, 400, {0.5, 1, 0});
  for (const auto& [name, order] :
       {std::pair{"md-imex-8-3-mixed", 3}, {"ark-548", 5}, {"md-imex-16-4-accurate", 4}}) {
    const double coarse = distance(end_of(name, problem, 20, {0.5, 1}), exact),
                 fine = distance(end_of(name, problem, 40, {0.5, 1}), exact);
    EXPECT_GT(std::log2(coarse / fine), order - 0.35) << name;
  }
}

TEST(timed_collision, stiff_solutions_that_move_with_time_are_followed_in_long_steps) {
  // Prothero & Robinson (1974): u' = −λ(u − sin t) + cos t. The stiff solution is sin t for every λ.
  for (const double fast : {1e3, 1e6, 1e9, 1e12}) {
    newton_problem problem(no_transport{}, [fast](const auto& t, const auto& u, auto& out) {
      using std::sin, std::cos;
      out[0] = cos(t) - fast * (u[0] - sin(t));
    });
    const apsis::method& m = apsis::find_method("imdrk-9-5-accurate");
    apsis::stepper march(m, problem, apsis::solutions::result_and_embedded);
    apsis::step_controller<double> control(1.0, apsis::estimate_of(m).order);
    row u{0};
    const auto done =
        apsis::integrate_to_tolerance(march, u, 0.0, 10.0, apsis::step_rule<double>::unlimited(), control,
                                      apsis::component_tolerances(1e-6, 1e-6));
    EXPECT_LT(done.steps, 300) << fast;
    EXPECT_NEAR(u[0], std::sin(10.0), 3e-5) << fast;  // 20 tolerances
  }
}

/// The equation `driven` with derivatives by hand.
struct driven_by_hand {
  double t = 0;
  void set_time(double now) { t = now; }
  void value(std::span<const double> u, std::span<double> out) const { driven(t, u, out); }
  void jacobian_product(std::span<const double> u, std::span<const double> x, std::span<double> jx) const {
    const double off = u[0] - std::sin(t);
    jx[0] = (-3 * off * off - 1) * x[0];
    jx[1] = std::cos(3 * t) * x[0] - std::sin(t) * x[1];
  }
  void curvature(std::span<const double> u, std::span<const double> k, std::span<const double> x,
                 std::span<double> hx) const {
    hx[0] = -6 * (u[0] - std::sin(t)) * k[0] * x[0];
    hx[1] = 0;
  }
  void time_derivative(std::span<const double> u, std::span<double> out) const {
    const double off = u[0] - std::sin(t);
    out[0] = -std::sin(t) + (3 * off * off + 1) * std::cos(t);
    out[1] = -3 * u[0] * std::sin(3 * t) - u[1] * std::cos(t);
  }
};

TEST(timed_collision, derivatives_by_hand_give_the_same_stage) {
  newton_problem by_hand(no_transport{}, driven_by_hand{});
  newton_problem automatic(no_transport{}, driven);
  row u{0.5, -0.2}, v{0.5, -0.2};
  by_hand.solve_timed_collision(0.7, 0.3, -0.05, u);
  automatic.solve_timed_collision(0.7, 0.3, -0.05, v);
  for (std::size_t i = 0; i < 2; ++i) EXPECT_NEAR(u[i], v[i], 1e-14);
}

}  // namespace
}  // namespace timed_collision_test
