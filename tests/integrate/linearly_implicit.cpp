// Linearly implicit extrapolation in lanes: its order, its errors for stiff systems, and what it keeps of
// systems alone.
#include <apsis/integrate/ensemble.hpp>

#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <integrate/random.hpp>
#include <integrate/robertson_ensemble.hpp>
#include <support/bad_input.hpp>
#include <support/property.hpp>

namespace ensemble_test {
namespace {

using apsis::linearly_implicit;

/// u' = t − 0.4 u + 1/(1 + u), split into F = t − 0.4 u and G = 1/(1 + u).
constexpr auto slow_part = [](double t, auto u, auto, auto f) { f[0] = t - 0.4 * u[0]; };
constexpr auto fast_part = [](double, auto u, auto, auto f) { f[0] = 1.0 / (1.0 + u[0]); };

numbers solution(const linearly_implicit& steps, double t1, double tolerance) {
  numbers u{0.2, 0.4, 0.6, 0.8, 1.0, 1.2, 1.4, 1.6};
  apsis::integrate_ensemble<1>(steps, slow_part, fast_part, u, {}, 0.0, t1, tolerances(tolerance, tolerance));
  return u;
}

}  // namespace

TEST(linearly_implicit, a_single_step_has_an_error_of_the_order_plus_one) {
  for (int order = 2; order <= 8; ++order) {
    // A large tolerance makes a single step of the interval.
    const auto error = [&](double t1) {
      const numbers u = solution({order}, t1, 1e10), exact = solution({8}, t1, 1e-13);
      double sum = 0.0;
      for (std::size_t k = 0; k < u.size(); ++k) sum += std::abs(u[k] - exact[k]);
      return sum;
    };
    // Higher orders need longer steps: their errors would be rounding. The error of a step H is C H^{K+1} (1
    // + O(H)).
    const double t1 = order < 5 ? 0.2 : order < 7 ? 0.4 : 0.7;
    EXPECT_NEAR(std::log2(error(t1) / error(t1 / 2)), order + 1, 0.5) << order;
  }
}

TEST(linearly_implicit, every_system_is_as_accurate_as_its_tolerance_asks) {
  const std::size_t compared[] = {0, 7, 8, 20};
  const robertson_ensemble start(21);
  for (const std::size_t s : compared) {
    const auto first = start.parameters.begin() + static_cast<long>(3 * s);
    const numbers exact = robertson_alone({first, first + 3}, 1e4, 1e-9);
    for (const double tolerance : {1e-3, 1e-4, 1e-6, 1e-8})
      for (const auto& steps : {linearly_implicit{}, linearly_implicit{4}, linearly_implicit{6}}) {
        if (tolerance < 1e-7 && steps.order == 4) continue;  // some 10^4 steps
        robertson_ensemble ensemble(21);
        ensemble.advance(steps, 1e4, tolerance);
        const double* u = &ensemble.u[3 * s];
        // Errors of steps add up to at most ten times the tolerance of a step.
        for (std::size_t i = 0; i < 3; ++i)
          EXPECT_NEAR(u[i], exact[i], 10 * tolerance * exact[i]) << tolerance << " " << s << " " << i;
        // Columns of the matrix add up to 1, so that every solve conserves the sum.
        EXPECT_NEAR(u[0] + u[1] + u[2], 1.0, 1e-11);
      }
  }
}

TEST(linearly_implicit, reaches_late_times_without_iterations) {
  robertson_ensemble ensemble(8);
  const auto counts = ensemble.advance(linearly_implicit{}, 1e11, 1e-6);
  EXPECT_NEAR(ensemble.u[0] / 0.2083340149701255e-7, 1.0, 1e-4);
  EXPECT_NEAR(ensemble.u[1] / 0.8333360770334713e-13, 1.0, 1e-4);
  EXPECT_EQ(counts.matrices, counts.steps);                         // a rejected step keeps its matrix
  EXPECT_EQ(counts.solves, 28 * (counts.steps + counts.rejected));  // 1 + 2 + … + 7
}

TEST(linearly_implicit, relaxation_of_any_stiffness_follows_its_equilibrium) {
  // u' = −k (u − cos t) − sin t is split into T = −sin t and Q = −k (u − cos t). The solution is u = cos t.
  const auto f = [](double t, auto, auto, auto out) { out[0] = -std::sin(t); };
  const auto g = [](double t, auto u, auto k, auto out) { out[0] = k[0] * (std::cos(t) - u[0]); };
  for (const double k : {1.0, 1e2, 1e4, 1e8, 1e12}) {
    numbers u{1.0};
    const auto counts = apsis::integrate_ensemble<1, 1>(linearly_implicit{}, f, g, u, numbers{k}, 0.0, 3.0,
                                                        tolerances(1e-7, 1e-7));
    EXPECT_NEAR(u[0], std::cos(3.0), 1e-6) << k;
    EXPECT_LT(counts.steps, 2000) << k;  // accuracy limits the steps, not k
  }
}

TEST(linearly_implicit, parts_of_eight_have_the_bits_of_the_whole) {
  robertson_ensemble whole(21), parts(21);
  whole.advance(linearly_implicit{}, 1e3, 1e-5);
  for (const std::size_t first : {16u, 0u, 8u}) {
    const std::size_t size = std::min<std::size_t>(8, 21 - first);
    apsis::integrate_ensemble<3, 3>(linearly_implicit{}, apsis::no_lane_transport{}, robertson,
                                    std::span(parts.u).subspan(3 * first, 3 * size),
                                    std::span(parts.parameters).subspan(3 * first, 3 * size), 0.0, 1e3,
                                    of_robertson(1e-5));
  }
  EXPECT_EQ(parts.u, whole.u);
}

TEST(linearly_implicit, lanes_are_alike) {
  check_property("lanes of an ensemble", [] {
    const std::size_t systems = static_cast<std::size_t>(random_input::integer(1, 12));
    robertson_ensemble copies(systems), one(1);
    for (double& k : one.parameters) k *= random_input::magnitude(-1, 1);
    for (std::size_t k = 0; k < copies.parameters.size(); ++k) copies.parameters[k] = one.parameters[k % 3];
    const double t1 = random_input::magnitude(-2, 4);
    one.advance(linearly_implicit{}, t1, 1e-5);
    copies.advance(linearly_implicit{}, t1, 1e-5);
    for (std::size_t k = 0; k < copies.u.size(); ++k) EXPECT_EQ(copies.u[k], one.u[k % 3]);
  });
}

TEST(linearly_implicit, a_state_at_rest_needs_the_fewest_steps) {
  numbers u(3, 2.0);
  const auto counts =
      apsis::integrate_ensemble<1>(linearly_implicit{}, apsis::no_lane_transport{},
                                   apsis::no_lane_transport{}, u, {}, 0.0, 1e6, tolerances(1e-6, 1e-6));
  EXPECT_EQ(counts.steps, 1);
  EXPECT_EQ(u, numbers(3, 2.0));
  apsis::integrate_ensemble<1>(linearly_implicit{}, apsis::no_lane_transport{}, apsis::no_lane_transport{}, u,
                               {}, 2.0, 2.0, tolerances(1e-6, 1e-6));
  EXPECT_EQ(u, numbers(3, 2.0));
}

TEST(linearly_implicit, names_the_system_that_fails) {
  // u' = u² reaches infinity at t = 1/u(0).
  const auto explodes = [](double, auto v, auto, auto out) { out[0] = v[0] * v[0]; };
  const auto undefined = [](double, auto v, auto, auto out) { out[0] = v[0] * std::nan(""); };
  numbers u(16, 0.1);
  u[11] = 2.0;
  try {
    apsis::integrate_ensemble<1>(linearly_implicit{}, apsis::no_lane_transport{}, explodes, u, {}, 0.0, 1.0,
                                 tolerances(1e-6, 1e-6));
    ADD_FAILURE() << "no error";
  } catch (const apsis::numerical_error& failure) {
    EXPECT_EQ(failure.site().cell, 11);
    EXPECT_NEAR(failure.site().t, 0.5, 1e-3);
  }
  EXPECT_NEAR(u[0], 0.1 / 0.9, 1e-5);  // groups before the failed one have reached the end
  EXPECT_EQ(u[11], 2.0);
  EXPECT_EQ(u[15], 0.1);
  try {
    apsis::integrate_ensemble<1>(linearly_implicit{}, apsis::no_lane_transport{}, undefined, u, {}, 0.0, 1.0,
                                 tolerances(1e-6, 1e-6));
    ADD_FAILURE() << "no error";
  } catch (const apsis::numerical_error& failure) {
    EXPECT_NE(std::string(failure.problem()).find("steps have no finite result"), std::string::npos);
    EXPECT_EQ(failure.site().t, 0.0);
  }
}

TEST(linearly_implicit, refuses_orders_it_does_not_have) {
  const auto with = [](int order) { return [order] { solution({order}, 0.1, 1e-3); }; };
  bad_input::expect_refused({
      {with(1), {"the order of extrapolation is 1 (it is from 2 to 8)"}},
      {with(9), {"the order of extrapolation is 9 (it is from 2 to 8)"}},
  });
}

}  // namespace ensemble_test
