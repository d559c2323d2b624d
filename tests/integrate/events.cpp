// Events: their order, directions and ends. Also the search for a change of sign.
#include <apsis/integrate/evolution.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <integrate/evolution_model.hpp>
#include <support/bad_input.hpp>

namespace evolution_test {

namespace {

constexpr double pi = 3.14159265358979323846;

/// Returns events of components, g_k = u_k − level_k.
oscillation::functions crossings(std::vector<double> levels, std::vector<int> directions,
                                 std::vector<bool> ends) {
  const std::size_t count = levels.size();
  return {count,
          [levels](double, const state& u, std::span<double> g) {
            for (std::size_t k = 0; k < g.size(); ++k) g[k] = u[k] - levels[k];
          },
          std::move(directions), std::move(ends)};
}

}  // namespace

TEST(events, are_found_with_the_order_of_the_method) {
  auto problem = oscillator();
  for (const auto& [name, order] : {std::pair<std::string, int>{"ssprk-3-3", 3}, {"kutta-4", 4}}) {
    double errors[2];
    for (int k = 0; k < 2; ++k) {
      oscillation one(apsis::find_integrator(name), problem, rule::fixed(0.125 / (k + 1)));
      one.set_events(crossings({0.25}, {}, {}));
      one.start(0.0, {1, 0});
      EXPECT_EQ(one.advance(10.0), end::event);
      errors[k] = std::abs(one.t() - std::acos(0.25));
      ASSERT_EQ(one.found().size(), 1U);
      EXPECT_EQ(one.found()[0].t, one.t());
      EXPECT_LE(one.u()[0], 0.25);  // just after the crossing
      EXPECT_NEAR(one.u()[0], 0.25, 1e-13);
    }
    EXPECT_NEAR(std::log2(errors[0] / errors[1]), order, 0.25) << name;
  }
}

TEST(events, come_in_order_with_their_directions_and_continue_after_an_end) {
  auto problem = oscillator();
  oscillation one(apsis::find_integrator("dop853"), problem, rule::fixed(0.5));
  // u1 falls through 0.1 at acos 0.1 and rises through it at 2π − acos 0.1. u2 falls through −0.5 at π/6.
  std::vector<std::pair<std::size_t, double>> seen;
  one.set_events(crossings({0.1, -0.5}, {-1, 0}, {false, true}),
                 [&](std::size_t k, double t, const state& u) {
                   seen.emplace_back(k, t);
                   EXPECT_NEAR(u[k], k == 0 ? 0.1 : -0.5, 1e-13);
                 });
  one.start(0.0, {1, 0});
  EXPECT_EQ(one.advance(2 * pi), end::event);
  EXPECT_NEAR(one.t(), pi / 6, 1e-9);
  EXPECT_EQ(one.advance(2 * pi), end::event);  // u2 rises through −0.5; before it u1 falls through 0.1
  EXPECT_NEAR(one.t(), 5 * pi / 6, 1e-9);
  EXPECT_EQ(one.advance(2 * pi), end::reached);  // the rise of u1 is no event
  ASSERT_EQ(seen.size(), 3U);
  EXPECT_EQ(seen[1].first, 0U);
  EXPECT_NEAR(seen[1].second, std::acos(0.1), 1e-9);
  EXPECT_EQ(one.found().size(), 3U);
  EXPECT_NEAR(one.u()[0], 1.0, 1e-8);
  EXPECT_EQ(one.t(), 2 * pi);
}

TEST(events, end_a_step_before_later_events_of_the_same_step) {
  auto problem = oscillator();
  oscillation one(apsis::find_integrator("dop853"), problem, rule::fixed(0.5));
  one.set_events({2, [](double t, const state&, std::span<double> g) {
                    g[0] = t - 0.3;
                    g[1] = t - 0.2;
                  }});
  one.start(0.0, {1, 0});
  std::vector<double> lengths;
  const auto observe = [&](long, double, double length, const state&) {
    lengths.push_back(length);
    return true;
  };
  EXPECT_EQ(one.advance(1.0, observe), end::event);
  EXPECT_NEAR(one.t(), 0.2, 1e-13);
  ASSERT_EQ(one.found().size(), 1U);
  EXPECT_EQ(one.found()[0].function, 1U);
  EXPECT_EQ(one.advance(1.0, observe), end::event);
  EXPECT_NEAR(one.t(), 0.3, 1e-13);
  EXPECT_EQ(one.found().size(), 2U);
  ASSERT_EQ(lengths.size(), 2U);
  EXPECT_NEAR(lengths[0], 0.2, 1e-13);
  EXPECT_NEAR(lengths[1], 0.1, 1e-13);
}

// A zero at the start does not count as an event, nor does the event at which the last integration ended.
TEST(events, at_the_start_are_left_before_they_count) {
  auto problem = oscillator();
  oscillation one(apsis::find_integrator("dop853"), problem, rule::fixed(0.25));
  one.set_events(crossings({1.0, 0.0}, {}, {}));  // u1 = 1 and u2 = 0 at t = 0
  one.start(0.0, {1, 0});
  EXPECT_EQ(one.advance(10.0), end::event);
  EXPECT_NEAR(one.t(), pi, 1e-9);  // u2 = −sin t; u1 does not cross 1
  EXPECT_EQ(one.found()[0].function, 1U);
}

TEST(events, of_formulas_with_equal_steps_end_within_their_local_error) {
  auto problem = ode_model::as_relaxation<state>(1e-3);
  double times_found[2];
  for (int k = 0; k < 2; ++k) {
    evolution one(apsis::find_integrator("imex-bdf-3"), problem, rule::fixed(1.0 / (64 << k)));
    one.set_events({1, [](double, const state& u, std::span<double> g) { g[0] = u[0] - 2.3; }});
    one.start(0.0, {2, std::sin(2.0)});
    EXPECT_EQ(one.advance(1.0), end::event);
    EXPECT_NEAR(one.u()[0], 2.3, 1e-4);
    times_found[k] = one.t();
    EXPECT_EQ(one.advance(1.0), end::reached);  // with the starter
  }
  EXPECT_NEAR(times_found[0], times_found[1], 1e-4);
}

TEST(events, that_are_nan_end_the_integration_with_an_error) {
  auto problem = oscillator();
  oscillation one(apsis::find_integrator("dop853"), problem, rule::fixed(0.25));
  one.set_events(
      {1, [](double t, const state&, std::span<double> g) { g[0] = t > 0.5 ? std::nan("") : 1.0; }});
  one.start(0.0, {1, 0});
  try {
    one.advance(1.0);
    ADD_FAILURE() << "no error";
  } catch (const apsis::numerical_error& failure) {
    EXPECT_THAT(failure.what(), testing::HasSubstr("event function 0 is NaN"));
  }
}

TEST(time_after_sign_change, halves_the_bracket_of_hostile_functions) {
  const std::vector<std::function<double(double)>> functions = {
      [](double t) { return t < 0.3 ? -1e-300 : 1.0; },       // a jump from almost 0
      [](double t) { return std::pow(t - 0.7, 9.0); },        // flat
      [](double t) { return std::expm1(300 * (t - 0.01)); },  // steep on one side
      [](double t) { return t < 0.999999 ? -1.0 : 1e6; }, [](double t) { return 0.5 - t; }};
  for (const auto& g : functions) {
    int count = 0;
    const auto counted = [&](double t) {
      ++count;
      return g(t);
    };
    const double b = apsis::time_after_sign_change(counted, 0.0, g(0.0), 1.0, g(1.0), 1e-13);
    EXPECT_NE(g(b) > 0, g(0.0) > 0);
    EXPECT_EQ(g(std::max(b - 1e-13, 0.0)) > 0, g(0.0) > 0);
    EXPECT_LE(count, 180);  // four times the halvings of the bracket
  }
}

}  // namespace evolution_test
