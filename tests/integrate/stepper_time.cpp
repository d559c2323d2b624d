// Time dependence in the stepper, and the time loop.
#include <apsis/integrate/exact_collisions.hpp>
#include <apsis/integrate/integrate.hpp>
#include <apsis/integrate/newton_problem.hpp>
#include <apsis/method/certificate.hpp>
#include <apsis/method/precision.hpp>

#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

namespace stepper_time_test {

namespace {

/// A problem with the known solution u/(1 + su) of u' = −u².
template <class Problem>
struct with_known_square : Problem {
  void advance_collision(long double, long double s, std::vector<long double>& u) const {
    u[0] /= 1 + s * u[0];
  }
};

/// Returns the error for u' = T(t) − u² with the solution 2 + sin t, so T = cos t + (2 + sin t)².
long double forced_error(const std::string& name, int steps) {
  using real = long double;
  using state = std::vector<real>;
  const auto force = [](real t, const state&, state& out) {
    out[0] = std::cos(t) + (2 + std::sin(t)) * (2 + std::sin(t));
  };
  const auto square = [](const auto& u, auto& out) { out[0] = -u[0] * u[0]; };
  auto p = apsis::make_newton_problem<state>(force, square);
  const auto error = [&](auto& problem) {
    apsis::stepper s(apsis::find_method(name), problem);
    state u = {2};
    apsis::integrate(s, u, real(0), real(1),
                     apsis::step_rule<real>::fixed(real(1) / static_cast<real>(steps)));
    return std::abs(u[0] - (2 + std::sin(real(1))));
  };
  if (apsis::find_method(name).kind != apsis::method_kind::exact_collision) return error(p);
  with_known_square<decltype(p)> known{p};
  apsis::exact_collisions exact(known);
  return error(exact);
}

/// The same equation in multiprecision for explicit methods. Their errors would soon be smaller than rounding
/// errors of long double.
struct forced_square {
  using state = apsis::mp_real;
  using real = apsis::mp_real;
  using targets = std::span<const apsis::target<state, real>>;

  void add_transport(real t, const state& u, targets to) {
    const state sine = 2 + sin(t);
    for (const auto& one : to) *one.acc = one.combine(*one.acc, u, state(cos(t) + sine * sine));
  }
  void add_collision(real, const state& u, targets to) {
    for (const auto& one : to) *one.acc = one.combine(*one.acc, u, state(-u * u));
  }
  void solve_collision(real, real, real, state&) {}
  real forward_euler_step(real, const state&) const { return 1; }
};

double explicit_error(const std::string& name, int steps) {
  using real = apsis::mp_real;
  forced_square problem;
  apsis::stepper s(apsis::find_method(name), problem);
  const real end = 3, dt = end / steps;
  real u = 2;
  for (int k = 0; k < steps; ++k) s.step(k * dt, dt, u);
  return static_cast<double>(abs(u - (2 + sin(end))));
}

}  // namespace

TEST(stepper, every_method_with_transport_has_its_order_for_time_dependent_transport) {
  for (const auto& name : apsis::method_names()) {
    const apsis::method_kind kind = apsis::find_method(name).kind;
    if (kind == apsis::method_kind::implicit_only) continue;
    const int order = apsis::find_certificate(name).order;
    if (kind == apsis::method_kind::explicit_only) {
      // The first error term of cash-karp-5 is very small. The second is 6 % of it in steps of 1/200.
      EXPECT_NEAR(std::log2(explicit_error(name, 640) / explicit_error(name, 1280)), order, 0.1) << name;
      continue;
    }
    // The second error term is below 7 % of the first, even where the first is small. Rounding in long double
    // is far below both, in fifth order with fewer steps.
    const int steps = order < 5 ? 640 : 80;
    const long double slope = std::log2(forced_error(name, steps) / forced_error(name, 2 * steps));
    EXPECT_NEAR(static_cast<double>(slope), order, 0.1) << name;
  }
}

TEST(time_marcher, an_interval_of_length_zero_has_no_steps) {
  EXPECT_TRUE(apsis::time_marcher<double>(1.0, 1.0).done());
  EXPECT_TRUE(apsis::time_marcher<double>(1.0, 1.0, 0.1).done());
}

TEST(time_marcher, a_dt_that_divides_the_interval_is_kept_and_ends_exactly) {
  apsis::time_marcher<double> march(0.0, 0.5, 0.5 / 3600);
  EXPECT_FALSE(march.adjusted());
  while (!march.done()) march.advance(march.next(0.0));
  EXPECT_EQ(march.step(), 3600);
  EXPECT_EQ(march.t(), 0.5);
}

TEST(time_marcher, a_dt_that_does_not_divide_the_interval_is_reduced) {
  const apsis::time_marcher<double> march(0.0, 1.0, 0.3);
  EXPECT_TRUE(march.adjusted());
  EXPECT_DOUBLE_EQ(*march.fixed_dt(), 0.25);
  // A relative deviation of 1e-12 still counts as dividing.
  EXPECT_FALSE(apsis::time_marcher<double>(0.0, 1.0, 0.1 * (1.0 + 5e-13)).adjusted());
  EXPECT_TRUE(apsis::time_marcher<double>(0.0, 1.0, 0.1 * (1.0 + 5e-12)).adjusted());
}

TEST(time_marcher, without_dt_few_steps_have_equal_length_and_rounding_adds_no_step) {
  apsis::time_marcher<double> march(0.0, 1.0);
  std::vector<double> steps;
  while (!march.done()) {
    steps.push_back(march.next(0.3));
    march.advance(steps.back());
  }
  EXPECT_EQ(steps, std::vector<double>(4, 0.25));
  EXPECT_EQ(march.t(), 1.0);
  // The interval has 36000 steps of a length that divides it up to rounding. There must be no 36001st step.
  apsis::time_marcher<double> many(0.0, 0.5);
  const double dt = 0.5 / 36000;
  while (!many.done()) many.advance(many.next(dt));
  EXPECT_EQ(many.step(), 36000);
}

TEST(time_marcher, without_dt_no_sliver_is_left_and_only_the_last_64_steps_depend_on_the_end) {
  for (int trial = 0; trial < 300; ++trial) {
    const double dt = 1e-3 * (1.0 + 0.37 * trial), start = trial % 3 == 0 ? -2.0 : 0.0;
    const double end = start + 1.0 + 0.618 * trial;
    apsis::time_marcher<double> march(start, end);
    double before = 0.0, last = 0.0;
    while (!march.done()) {
      const double left = end - march.t();
      before = last;
      last = march.next(dt);
      EXPECT_LE(last, dt);
      if (left >= 64.0 * dt) {
        EXPECT_EQ(last, dt) << trial;
      }
      if (left >= 65.0 * dt) {
        EXPECT_FALSE(march.shaped_by_end(dt)) << trial;
      }
      // If n steps share a remainder, each is shortened by at most 1/n.
      if (left < 64.0 * dt && march.step() >= 64) {
        EXPECT_GE(last, dt * (1.0 - 1.0 / 63.0)) << trial;
      }
      march.advance(last);
    }
    EXPECT_EQ(march.t(), end);
    if (march.step() > 1) {
      EXPECT_EQ(last, before) << trial;
    }
  }
}

TEST(time_marcher, divides_the_time_between_stops_into_steps_of_one_length) {
  for (const double every : {0.1, 0.3, 1.0 / 7.0, 1.7}) {
    for (const double dt : {0.001, 0.0137, 0.03, 0.26, 5.0}) {
      apsis::time_marcher<double> march(0.0, 9.0 * every);
      march.stop_every(every);
      const double first = march.next(dt);
      EXPECT_NEAR(first, every / std::ceil(every / dt * (1.0 - 1e-14)), 1e-15);
      while (!march.done()) {
        // The steps have the same bits, so methods of several steps need not restart.
        EXPECT_EQ(march.next(dt), first) << every << ", " << dt << " at " << march.t();
        march.advance(march.next(dt));
      }
      EXPECT_EQ(march.t(), 9.0 * every);
    }
  }
}

TEST(time_marcher, rejects_invalid_intervals_and_steps) {
  const double inf = std::numeric_limits<double>::infinity(), nan = std::nan("");
  EXPECT_THROW(apsis::time_marcher<double>(1.0, 0.0), apsis::input_error);
  EXPECT_THROW(apsis::time_marcher<double>(0.0, inf), apsis::input_error);
  EXPECT_THROW(apsis::time_marcher<double>(0.0, 1.0, 0.0), apsis::input_error);
  EXPECT_THROW(apsis::time_marcher<double>(0.0, 1.0, -0.1), apsis::input_error);
  EXPECT_THROW(apsis::time_marcher<double>(0.0, 1.0, nan), apsis::input_error);
  EXPECT_THROW(apsis::time_marcher<double>(0.0, 1.0, 1e-300), apsis::input_error);
  const apsis::time_marcher<double> march(0.0, 1.0);
  EXPECT_THROW(march.next(inf), apsis::input_error);
  EXPECT_THROW(march.next(nan), apsis::numerical_error);
  EXPECT_THROW(march.next(0.0), apsis::numerical_error);
  EXPECT_THROW(apsis::time_marcher<double>(1e6, 2e6).next(1e-12), apsis::numerical_error);
}

TEST(time_marcher, is_restored_bitwise_from_a_save) {
  apsis::time_marcher<double> whole(0.0, 0.7), first(0.0, 0.7);
  const auto march = [](apsis::time_marcher<double>& m, int steps) {
    for (int k = 0; k < steps && !m.done(); ++k) m.advance(m.next(0.013));
  };
  march(whole, 1000);
  march(first, 20);
  apsis::time_marcher<double> second(0.0, 0.7);
  second.resume(first.save());
  march(second, 10);
  march(first, 10);
  EXPECT_EQ(first.t(), second.t());
  march(second, 1000);
  EXPECT_EQ(second.t(), whole.t());
  EXPECT_EQ(second.step(), whole.step());
}

TEST(integrate, reports_step_and_time_of_a_failure_and_keeps_the_last_good_state) {
  // u' = u² in T blows up. The guarded implicit part rejects values that are not finite.
  const auto blow_up = [](double, const std::vector<double>& u, std::vector<double>& out) {
    out[0] = 1e200 * u[0] * u[0];
  };
  const auto damp = [](const auto& u, auto& out) { out[0] = -u[0]; };
  apsis::newton_problem p(blow_up, damp);
  apsis::stepper s(apsis::find_method("md-imex-3-2"), p);
  std::vector<double> u = {1.0}, last = u;
  long good = -1;
  try {
    apsis::integrate(s, u, 0.0, 1.0, apsis::step_rule<double>::fixed(0.1),
                     [&](long step, double, double, const std::vector<double>& now) {
                       good = step;
                       last = now;
                     });
    FAIL() << "no error";
  } catch (const apsis::numerical_error& failure) {
    EXPECT_EQ(failure.site().step, good + 1);
    EXPECT_FALSE(std::isnan(failure.site().t));
  }
  EXPECT_EQ(u, last);
}

TEST(integrate, can_be_ended_by_the_observer) {
  const auto none = [](double, const std::vector<double>&, std::vector<double>& out) { out[0] = 0.0; };
  const auto damp = [](const auto& u, auto& out) { out[0] = -u[0]; };
  apsis::newton_problem p(none, damp);
  apsis::stepper s(apsis::find_method("md-imex-3-2"), p);
  std::vector<double> u = {1.0};
  const auto result =
      apsis::integrate(s, u, 0.0, 1.0, apsis::step_rule<double>::fixed(0.1),
                       [](long step, double, double, const std::vector<double>&) { return step < 3; });
  EXPECT_EQ(result.steps, 3);
  EXPECT_DOUBLE_EQ(result.t, 0.3);
}

}  // namespace stepper_time_test
