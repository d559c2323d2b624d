// Integration in intervals, by integrators of every kind: the bits of integrate(), what survives its end,
// dense output, events and stop times.
#include <apsis/integrate/evolution.hpp>

#include <apsis/integrate/relaxation_problem.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <integrate/ode_model.hpp>
#include <support/bad_input.hpp>

namespace evolution_test {

namespace {

using state = std::vector<double>;
using rule = apsis::step_rule<double>;
using model = decltype(ode_model::as_relaxation<state>(0.3));
using evolution = apsis::evolution<model>;
using end = apsis::evolution_end;

const std::vector<std::string> of_each_kind = {"md-imex-8-3-mixed", "dop853", "exponential-2", "imex-bdf-4",
                                               "two-step-8-3-narrow"};
constexpr std::array times = {0.0, 0.25, 0.5, 1.0};
constexpr double dt = 1.0 / 64;

double difference(const state& u, const state& v) {
  return std::max(std::abs(u[0] - v[0]), std::abs(u[1] - v[1]));
}

evolution::tolerance within(double tolerance) {
  return {tolerance, difference};
}

}  // namespace

TEST(evolution, has_the_bits_of_integrate_in_every_interval) {
  auto problem = ode_model::as_relaxation<state>(0.3);
  for (const auto& name : of_each_kind) {
    const auto& m = apsis::find_integrator(name);
    evolution one(m, problem, rule::fixed(dt));
    one.start(0.0, {2, 0});
    state expected{2, 0};
    for (std::size_t k = 1; k < times.size(); ++k) {
      apsis::with_stepper(m, problem, [&](auto march) {
        apsis::integrate(march, expected, times[k - 1], times[k], rule::fixed(dt));
      });
      EXPECT_EQ(one.advance(times[k]), end::reached);
      EXPECT_EQ(one.t(), times[k]);
      EXPECT_EQ(one.u(), expected) << name << " at " << times[k];
    }
    EXPECT_EQ(one.steps(), 64);
    EXPECT_EQ(one.rejected(), 0);
  }
}

TEST(evolution, keeps_the_controller_of_steps_from_one_interval_to_the_next) {
  auto problem = ode_model::as_relaxation<state>(0.3);
  for (const char* name : {"md-imex-6-3", "dop853"}) {
    const auto& m = apsis::find_integrator(name);
    evolution one(m, problem, rule::unlimited(), within(1e-6));
    one.start(0.0, {2, 0});
    apsis::stepper march(*m.one_step(), problem, apsis::solutions::result_and_embedded);
    apsis::step_controller<double> control(1e-6, apsis::estimate_of(*m.one_step()).order);
    state expected{2, 0};
    long steps = 0;
    for (std::size_t k = 1; k < times.size(); ++k) {
      steps += apsis::integrate_to_tolerance(march, expected, times[k - 1], times[k], rule::unlimited(),
                                             control, difference)
                   .steps;
      EXPECT_EQ(one.advance(times[k]), end::reached);
      EXPECT_EQ(one.u(), expected) << name << " at " << times[k];
    }
    EXPECT_EQ(one.steps(), steps);
    EXPECT_EQ(one.rejected(), control.rejected());
  }
}

TEST(evolution, ends_where_the_observer_wants_and_continues_from_there) {
  auto problem = ode_model::as_relaxation<state>(0.3);
  evolution one(apsis::find_integrator("md-imex-6-3"), problem, rule::fixed(dt));
  one.start(0.0, {2, 0});
  std::vector<long> seen;
  const auto up_to_five = [&seen, &one](long step, double t, double length, const state& u) {
    EXPECT_EQ(t, static_cast<double>(step) * dt);
    EXPECT_EQ(length, dt);
    EXPECT_EQ(&u, &one.u());
    seen.push_back(step);
    return step < 5;
  };
  EXPECT_EQ(one.advance(1.0, up_to_five), end::stopped);
  EXPECT_THAT(seen, testing::ElementsAre(1, 2, 3, 4, 5));
  EXPECT_EQ(one.t(), 5 * dt);
  EXPECT_EQ(one.advance(1.0), end::reached);
  evolution whole(apsis::find_integrator("md-imex-6-3"), problem, rule::fixed(dt));
  whole.start(0.0, {2, 0});
  EXPECT_EQ(whole.advance(1.0), end::reached);
  EXPECT_EQ(one.u(), whole.u());
}

TEST(evolution, grades_the_start_once) {
  auto problem = ode_model::as_relaxation<state>(1e-4);
  evolution one(apsis::find_integrator("md-imex-6-3"), problem, rule::fixed(dt).with(apsis::startup::graded));
  one.start(0.0, {2, 0});
  EXPECT_EQ(one.advance(0.5), end::reached);
  const long first = one.steps();
  EXPECT_GT(first, 32);
  EXPECT_EQ(one.advance(1.0), end::reached);
  EXPECT_EQ(one.steps(), first + 32);
  one.start(0.0, {2, 0});
  EXPECT_EQ(one.advance(0.5), end::reached);
  EXPECT_EQ(one.steps(), first);
}

TEST(evolution, names_the_step_since_the_start_where_one_fails) {
  double breaks_at = 0.6;
  auto problem = apsis::make_relaxation_problem<state>(
      [&breaks_at](double t, const state& u, state& out) {
        ode_model::transport(t, u, out);
        if (t > breaks_at) out[0] = std::nan("");
      },
      [](const state& u) { return u[0]; }, [](double w, state& out) { out = {w, std::sin(w)}; },
      [](double w) { return 1 + w * w; }, 0.3);
  apsis::evolution one(apsis::find_integrator("md-imex-6-3"), problem, rule::fixed(dt));
  one.start(0.0, {2, 0});
  EXPECT_EQ(one.advance(0.5), end::reached);
  try {
    one.advance(1.0);
    ADD_FAILURE() << "no error";
  } catch (const apsis::numerical_error& failure) {
    EXPECT_EQ(failure.site().step, one.steps() + 1);
    EXPECT_EQ(failure.site().t, one.t());
  }
  EXPECT_GT(one.t(), 0.5);
  EXPECT_LT(one.t(), 0.6);
  const double reached = one.t();
  breaks_at = 2.0;
  EXPECT_EQ(one.advance(reached + 1.0), end::reached);  // from the last accepted step
  EXPECT_EQ(one.t(), reached + 1.0);
}

TEST(evolution, refuses_what_its_method_cannot_do) {
  auto problem = ode_model::as_relaxation<state>(0.3);
  const auto& bdf = apsis::find_integrator("imex-bdf-3");
  const auto& m = apsis::find_integrator("md-imex-6-3");
  bad_input::expect_refused({
      {[&] { evolution(bdf, problem, rule::fixed(dt), within(1e-6)); },
       {"'imex-bdf-3' cannot follow a tolerance", "give dt alone"}},
      {[&] {
         evolution one(bdf, problem, rule::ssp());
         one.start(0.0, {2, 0});
         one.advance(1.0);
       },
       {"needs equal steps", "give dt"}},
      {[&] { evolution(m, problem, rule::fixed(dt), within(0.0)); },
       {"the tolerance is not a positive number"}},
      {[&] {
         evolution(m, problem, rule::fixed(dt))
             .set_events({2, [](double, const state&, std::span<double>) {}, {1}});
       },
       {"a list of events has 1 entries (there are 2 functions)"}},
      {[&] { evolution(m, problem, rule::fixed(dt)).start(std::nan(""), {2, 0}); },
       {"the initial time is not finite"}},
      {[&] {
         evolution one(m, problem, rule::fixed(dt));
         one.start(1.0, {2, 0});
         one.advance(0.5);
       },
       {"the time interval does not exist"}},
  });
}

namespace {

/// The largest difference of dense output at several places of every step to a reference.
template <class Reference>
double dense_error(const std::string& name, double epsilon, long steps, const Reference& reference) {
  auto problem = ode_model::as_relaxation<state>(epsilon);
  evolution one(apsis::find_integrator(name), problem, rule::fixed(1.0 / static_cast<double>(steps)));
  one.start(0.0, {2, std::sin(2.0)});
  double largest = 0.0;
  one.advance(1.0, [&](long, double t, double length, const state&) {
    for (const double part : {0.25, 0.5, 0.75}) {
      const double at = t - part * length;
      largest = std::max(largest, difference(one.at(at), reference(at)));
    }
    return true;
  });
  return largest;
}

/// The model at t by 2048 steps of order 4, whose errors are below 1e-13 for ε = 1; t is a multiple of
/// 1/1024.
state reference_at(double t) {
  static const std::vector<state> all = [] {
    auto problem = ode_model::as_relaxation<state>(1.0);
    apsis::stepper march(apsis::find_method("kutta-4"), problem);
    std::vector<state> found;
    state u{2, std::sin(2.0)};
    apsis::integrate(march, u, 0.0, 1.0, rule::fixed(1.0 / 2048),
                     [&found](long, double, double, const state& now) { found.push_back(now); });
    return found;
  }();
  return all.at(static_cast<std::size_t>(std::lround(2048 * t)));
}

/// u1' = u2, u2' = −u1, from (1, 0): u = (cos t, −sin t), as transport alone.
auto oscillator() {
  return apsis::relaxation_problem([](double, const state& u, state& out) { out = {u[1], -u[0]}; },
                                   [](const state& u) { return u; }, [](const state& w, state& e) { e = w; },
                                   [](const state&) { return 0.0; }, 1.0);
}
using oscillation = apsis::evolution<decltype(oscillator())>;
constexpr double pi = 3.14159265358979323846;

/// Events of components: g_k = u_k − level_k.
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

TEST(dense_output, has_the_order_of_the_method) {
  for (const auto& [name, order] : {std::pair<std::string, int>{"md-imex-3-2", 2},
                                    {"md-imex-6-3", 3},
                                    {"kutta-4", 4},
                                    {"imex-bdf-3", 3},
                                    {"exponential-2", 2}}) {
    const double coarse = dense_error(name, 1.0, 128, reference_at),
                 fine = dense_error(name, 1.0, 256, reference_at);
    // md-imex-6-3 tends to its order from below: 2.53, 2.75 and 2.87 with 64, 128 and 256 steps.
    EXPECT_NEAR(std::log2(coarse / fine), order, 0.2) << name;
  }
}

TEST(dense_output, meets_the_solution_at_both_ends_of_a_step) {
  auto problem = ode_model::as_relaxation<state>(0.01);
  for (const std::string name : {"md-imex-6-3", "ssp2-222", "exponential-2"})
    for (const bool tolerated : {false, true}) {
      evolution one(apsis::find_integrator(name), problem, rule::fixed(dt),
                    tolerated ? std::optional(within(1e-4)) : std::nullopt);
      one.start(0.0, {2, 0});
      state before{2, 0};
      one.advance(0.25, [&](long, double t, double length, const state& u) {
        EXPECT_EQ(one.at(t), u);
        EXPECT_EQ(one.at(one.begin_of_step()), before);
        // A step as long as the last one: the same numbers, if the difference of times has its length.
        if (t - one.begin_of_step() == length) {
          const state almost = one.at(std::nextafter(t, 0.0));
          EXPECT_LT(difference(almost, u), 1e-13);
        }
        before = u;
        return true;
      });
      EXPECT_EQ(one.t(), 0.25) << name;
    }
}

// A caller who keeps the begins of steps has dense output of the whole interval, also after it.
TEST(dense_output, is_known_later_from_kept_begins_of_steps) {
  auto problem = ode_model::as_relaxation<state>(0.01);
  for (const char* name : {"md-imex-6-3", "dop853"}) {
    evolution one(apsis::find_integrator(name), problem, rule::unlimited(), within(1e-5));
    one.start(0.0, {2, 0});
    struct place {
      double begin, t;
      state before, inside;
    };
    std::vector<place> kept;
    state before{2, 0};
    one.advance(1.0, [&](long, double t, double length, const state& u) {
      kept.push_back({one.begin_of_step(), t - length / 3, before, one.at(t - length / 3)});
      before = u;
      return true;
    });
    for (const auto& [begin, t, from, inside] : kept)
      EXPECT_EQ(one.step_from(begin, from, t), inside) << name;
    EXPECT_EQ(one.step_from(kept[0].begin, kept[0].before, kept[0].begin), kept[0].before);
    bad_input::expect_refused(
        {{[&] { one.step_from(0.5, {2, 0}, 0.4); }, {"the time 0.4 is before the begin of its step (0.5)"}}});
  }
}

TEST(evolution, takes_a_given_first_step) {
  auto problem = ode_model::as_relaxation<state>(0.3);
  for (const double first : {1e-4, 1e-2}) {
    auto tolerance = within(1e-3);
    tolerance.first_step = first;
    evolution one(apsis::find_integrator("dop853"), problem, rule::unlimited(), tolerance);
    one.start(0.0, {2, 0});
    one.advance(1.0, [&](long, double, double length, const state&) {
      EXPECT_EQ(length, first);
      return false;
    });
  }
}

TEST(evolution, accepts_a_method_that_is_not_registered) {
  auto problem = ode_model::as_relaxation<state>(0.3);
  apsis::method own = apsis::find_method("md-imex-6-3");
  own.name = "own";
  evolution by_method(own, problem, rule::unlimited(), within(1e-5)),
      by_name(apsis::find_integrator("md-imex-6-3"), problem, rule::unlimited(), within(1e-5));
  for (evolution* one : {&by_method, &by_name}) {
    one->start(0.0, {2, 0});
    one->advance(1.0);
  }
  EXPECT_EQ(by_method.u(), by_name.u());
  EXPECT_EQ(by_method.steps(), by_name.steps());
}

TEST(dense_output, does_not_disturb_the_steps) {
  auto problem = ode_model::as_relaxation<state>(0.01);
  for (const auto& name : {"md-imex-6-3", "imex-bdf-4", "two-step-8-3-narrow", "exponential-2"}) {
    evolution quiet(apsis::find_integrator(name), problem, rule::fixed(dt)),
        watched(apsis::find_integrator(name), problem, rule::fixed(dt));
    for (evolution* one : {&quiet, &watched}) one->start(0.0, {2, 0});
    quiet.advance(1.0);
    watched.advance(1.0, [&](long, double t, double length, const state&) {
      watched.at(t - length / 3);
      return true;
    });
    EXPECT_EQ(watched.u(), quiet.u()) << name;
  }
}

// Polynomials through the steps would leave [0, 1]; a step does not.
TEST(dense_output, preserves_bounds_as_steps_do) {
  constexpr int cells = 40;
  auto advection = apsis::relaxation_problem(
      [](double, const state& u, state& out) {
        for (std::size_t i = 0; i < u.size(); ++i) out[i] = u[i == 0 ? u.size() - 1 : i - 1] - u[i];
      },
      [](const state& u) { return u; }, [](const state& w, state& e) { e = w; },
      [](const state&) { return 0.0; }, 1.0);
  const auto& m = apsis::find_integrator("ssprk-3-3");
  apsis::evolution one(m, advection, rule::fixed(m.ssp_coefficient));  // Δt_FE = 1
  state box(cells, 0.0);
  std::fill(box.begin() + 5, box.begin() + 15, 1.0);
  one.start(0.0, box);
  one.advance(20.0, [&](long, double t, double length, const state&) {
    for (const double part : {0.1, 0.35, 0.5, 0.9})
      for (const double x : one.at(t - part * length)) {
        EXPECT_GE(x, -1e-15);
        EXPECT_LE(x, 1.0 + 1e-15);
      }
    return true;
  });
}

TEST(dense_output, is_refused_outside_the_last_step) {
  auto problem = ode_model::as_relaxation<state>(0.3);
  evolution one(apsis::find_integrator("md-imex-6-3"), problem, rule::fixed(0.25));
  one.start(0.0, {2, 0});
  EXPECT_EQ(one.at(0.0), one.u());
  one.advance(0.5);
  bad_input::expect_refused({
      {[&] { one.at(0.2); }, {"the time 0.2 is not in the last step (from 0.25 to 0.5)"}},
      {[&] { one.at(0.6); }, {"is not in the last step"}},
      {[&] { one.at(std::nan("")); }, {"is not in the last step"}},
  });
}

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
  // u1 falls through 0.1 at acos 0.1, rises through it at 2π − acos 0.1; u2 falls through −0.5 at π/6.
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

// A zero at the start is no event, nor is one that an event left behind.
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

TEST(stop_times, end_steps_exactly_and_keep_the_order_of_discontinuous_data) {
  // u' = 1 for t < 1/3 and −1 after it, by steps that do not divide 1/3.
  auto problem =
      apsis::relaxation_problem([](double t, const state&, state& out) { out = {t < 1.0 / 3 ? 1.0 : -1.0}; },
                                [](const state& u) { return u; }, [](const state& w, state& e) { e = w; },
                                [](const state&) { return 0.0; }, 1.0);
  apsis::evolution one(apsis::find_integrator("forward-backward-euler"), problem, rule::fixed(0.125));
  one.set_stops({0.0, 1.0 / 3, 2.0});
  one.start(0.0, {0});
  std::vector<double> reached;
  EXPECT_EQ(one.advance(1.0,
                        [&](long, double t, double, const state&) {
                          reached.push_back(t);
                          return true;
                        }),
            end::reached);
  EXPECT_THAT(reached, testing::Contains(1.0 / 3));
  EXPECT_NEAR(one.u()[0], 1.0 / 3 - 2.0 / 3, 1e-15);
  bad_input::expect_refused({
      {[&] { one.set_stops({1.0, 0.5}); }, {"stop times do not increase (number 1"}},
      {[&] { one.set_stops({std::nan("")}); }, {"stop times do not increase (number 0"}},
  });
}

}  // namespace evolution_test
