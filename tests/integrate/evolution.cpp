// Integration in intervals, by integrators of every kind: the bits of integrate(), and what survives its end.
#include <apsis/integrate/evolution.hpp>

#include <apsis/integrate/relaxation_problem.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
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
      EXPECT_TRUE(one.advance(times[k]));
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
      EXPECT_TRUE(one.advance(times[k]));
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
  EXPECT_FALSE(one.advance(1.0, up_to_five));
  EXPECT_THAT(seen, testing::ElementsAre(1, 2, 3, 4, 5));
  EXPECT_EQ(one.t(), 5 * dt);
  EXPECT_TRUE(one.advance(1.0));
  evolution whole(apsis::find_integrator("md-imex-6-3"), problem, rule::fixed(dt));
  whole.start(0.0, {2, 0});
  EXPECT_TRUE(whole.advance(1.0));
  EXPECT_EQ(one.u(), whole.u());
}

TEST(evolution, grades_the_start_once) {
  auto problem = ode_model::as_relaxation<state>(1e-4);
  evolution one(apsis::find_integrator("md-imex-6-3"), problem, rule::fixed(dt).with(apsis::startup::graded));
  one.start(0.0, {2, 0});
  EXPECT_TRUE(one.advance(0.5));
  const long first = one.steps();
  EXPECT_GT(first, 32);
  EXPECT_TRUE(one.advance(1.0));
  EXPECT_EQ(one.steps(), first + 32);
  one.start(0.0, {2, 0});
  EXPECT_TRUE(one.advance(0.5));
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
  EXPECT_TRUE(one.advance(0.5));
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
  EXPECT_TRUE(one.advance(reached + 1.0));  // from the last accepted step
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

}  // namespace evolution_test
