// Integration in intervals by integrators of every kind: the bits of integrate(), state between intervals,
// stop times.
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
  EXPECT_EQ(one.advance(reached + 1.0), end::reached);  // continues from the last accepted step
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
      {[&] { evolution(m, problem, rule::fixed(dt)).set_events({1, {}}); },
       {"the function of the events is empty"}},
      {[&] { evolution(m, problem, rule::fixed(dt)).advance(1.0); }, {"start() was not called"}},
      {[&] { evolution(m, problem, rule::unlimited(), apsis::step_tolerance<state, double>{1e-6, {}}); },
       {"the tolerance has no distance between states"}},
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

TEST(stop_times, end_steps_exactly_and_keep_the_order_of_discontinuous_data) {
  // u' = 1 for t < 1/3 and −1 afterwards. The steps do not divide 1/3.
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
