// Graded start in the time loop. Only the first step is divided, into steps that double.
#include "ode_model.hpp"
#include "random.hpp"
#include "support/property.hpp"

#include <apsis/integrate/extrapolation.hpp>
#include <apsis/integrate/integrate.hpp>
#include <apsis/method/precision.hpp>

#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace startup_test {

namespace {

using apsis::startup;
using apsis::step_rule;
constexpr double infinite = std::numeric_limits<double>::infinity();

struct visited {
  std::vector<double> t, dt;
  long startup_steps = 0;
};

/// Records all times and steps. A negative `width` means no start-up.
visited march_through(apsis::time_marcher<double> march, double proposed, double width) {
  visited out{{march.t()}, {}, 0};
  if (width >= 0.0) march.start_up(proposed, width);
  while (!march.done()) {
    out.dt.push_back(march.next(proposed));
    march.advance(out.dt.back());
    out.t.push_back(march.t());
  }
  out.startup_steps = march.startup_steps();
  return out;
}

apsis::time_marcher<double> random_march(double& proposed, int growth = apsis::default_growth) {
  const double t0 = random_input::one_in(2) ? 0.0 : random_input::uniform(-3.0, 3.0);
  const double length = random_input::magnitude(-3, 2);
  const bool given = random_input::one_in(2);
  // The first step of a rule must be graded as proposed. It must not share the remainder before t1, as the
  // last time_marcher::shared_steps do.
  proposed = length / (given ? random_input::uniform(1.0, 40.0) : random_input::uniform(66.0, 120.0));
  return {t0, t0 + length, given ? std::optional<double>(proposed) : std::nullopt, growth};
}

TEST(startup, divides_the_first_step_and_keeps_all_later_times_bitwise) {
  check_property("start-up", [] {
    double proposed = 0.0;
    const auto march = random_march(proposed);
    const double width = proposed * random_input::magnitude(-14, 2);
    const auto plain = march_through(march, proposed, -1.0), cut = march_through(march, proposed, width);
    const auto extra = static_cast<std::size_t>(cut.startup_steps) - 1;
    RC_ASSERT(cut.t.size() == plain.t.size() + extra);
    for (std::size_t n = 1; n < plain.t.size(); ++n) RC_ASSERT(cut.t[n + extra] == plain.t[n]);
    for (std::size_t n = 1; n < plain.dt.size(); ++n) RC_ASSERT(cut.dt[n + extra] == plain.dt[n]);
    // The start-up steps add up to the first step, and each is as long as the time before it. The first
    // one is at most a quarter of the width. It exceeds an eighth of the width, so there are no more
    // steps than needed.
    double sum = 0.0;
    for (std::size_t k = 0; k <= extra; ++k) {
      RC_ASSERT(k == 0 || cut.dt[k] == sum);
      sum += cut.dt[k];
      RC_ASSERT(cut.t[k + 1] >= cut.t[k]);
    }
    RC_ASSERT(sum == plain.dt[0]);
    RC_ASSERT(4 * cut.dt[0] <= width);
    RC_ASSERT(extra == 0 || 8 * cut.dt[0] > width);
    const double wanted = std::max(0.0, std::ceil(std::log2(4 * plain.dt[0] / width)));
    RC_ASSERT(std::abs(static_cast<double>(extra) - wanted) <= 1.0);  // log2 rounds
  });
}

TEST(startup, with_any_ratio_keeps_later_times_and_takes_the_fewest_steps) {
  check_property("ratio", [] {
    double proposed = 0.0;
    const int growth = random_input::integer(2, 64);
    const auto march = random_march(proposed, growth);
    const double width = proposed * random_input::magnitude(-14, 2);
    const auto plain = march_through(march, proposed, -1.0), cut = march_through(march, proposed, width);
    const auto extra = static_cast<std::size_t>(cut.startup_steps) - 1;
    RC_ASSERT(cut.t.size() == plain.t.size() + extra);
    for (std::size_t n = 1; n < plain.t.size(); ++n) RC_ASSERT(cut.t[n + extra] == plain.t[n]);
    // A few divisions and a difference each round a step.
    const double rounding = 1e-14 * plain.dt[0];
    double time = 0.0;
    for (std::size_t k = 0; k <= extra; ++k) {
      RC_ASSERT(k == 0 || std::abs(cut.dt[k] - (growth - 1) * time) <= rounding);
      time += cut.dt[k];
    }
    RC_ASSERT(std::abs(time - plain.dt[0]) <= rounding);
    RC_ASSERT(cut.dt[0] <= growth / 8.0 * width);
    RC_ASSERT(extra == 0 || cut.dt[0] * (1.0 + 1e-13) > width / 8.0);
  });
}

TEST(startup, refuses_ratios_that_are_not_from_2_to_64) {
  for (const int growth : {-1, 0, 1, 65}) {
    try {
      apsis::time_marcher<double>(0.0, 1.0, 0.25, growth);
      ADD_FAILURE() << growth;
    } catch (const apsis::input_error& refused) {
      EXPECT_EQ(std::string(refused.what()), "the growth of a graded start is " + std::to_string(growth) +
                                                 " (the ratio of its times is from 2 to 64); give one in "
                                                 "this range");
    }
  }
}

TEST(startup, is_restored_bitwise_from_a_save_at_any_step) {
  check_property("restart", [] {
    double proposed = 0.0;
    const auto march = random_march(proposed, random_input::integer(2, 10));
    auto whole = march, part = march;
    const double width = proposed * random_input::magnitude(-9, 0);
    whole.start_up(proposed, width);
    part.start_up(proposed, width);
    for (int k = random_input::integer(0, 30); k > 0 && !part.done(); --k) part.advance(part.next(proposed));
    auto rest = march;
    rest.resume(part.save());
    while (!rest.done()) rest.advance(rest.next(proposed));
    while (!whole.done()) {
      whole.advance(whole.next(proposed));
      RC_ASSERT(whole.t() <= rest.t());
    }
    RC_ASSERT(whole.t() == rest.t());
    RC_ASSERT(whole.step() == rest.step());
    RC_ASSERT(whole.startup_steps() == rest.startup_steps());
  });
}

TEST(startup, does_nothing_without_a_layer_and_ends_for_every_width) {
  const apsis::time_marcher<double> march(0.0, 1.0, 0.25);
  for (const double width : {0.0, infinite, 1.0, 7.0})
    EXPECT_EQ(march_through(march, 0.25, width).startup_steps, 1) << width;
  // The effect of a thinner layer is below rounding. The number of steps is at most the number of
  // bits plus two.
  for (const double width : {1e-16, 1e-40, 1e-300, 4e-308}) {
    const auto cut = march_through(march, 0.25, width);
    EXPECT_LE(cut.startup_steps, 56) << width;
    EXPECT_GE(cut.startup_steps, 54) << width;
    EXPECT_EQ(cut.t.back(), 1.0);
    EXPECT_EQ(cut.dt.back(), 0.25);
  }
  EXPECT_EQ(march_through({2.0, 2.0}, 0.25, 1e-3).startup_steps, 0);      // no first step
  EXPECT_EQ(march_through({0.0, 0.25, 0.25}, 0.0, 0.01).t.back(), 0.25);  // only a first step
  EXPECT_EQ(march_through({0.0, 0.1}, 0.25, 0.01).t.back(), 0.1);         // shortened at the end
  EXPECT_THROW(march_through({0.0, 1.0}, infinite, 0.01), apsis::input_error);
}

TEST(startup, ends_if_the_rule_allows_only_shorter_steps) {
  apsis::time_marcher<double> march(0.0, 1.0);
  march.start_up(0.5, 0.125);  // 1/32, 1/32, 1/16, 1/8, 1/4
  double longest = 0.0;
  for (double allowed = 0.5; !march.done(); allowed = 0.1) {
    const double dt = march.next(allowed);
    EXPECT_LE(dt, allowed);
    march.advance(dt);
    longest = std::max(longest, dt);
  }
  EXPECT_EQ(march.t(), 1.0);
  EXPECT_EQ(longest, 0.875 / 9.0);  // the remainder after three steps, divided evenly
  EXPECT_EQ(march.startup_steps(), 3);
}

TEST(startup, counts_the_remaining_steps) {
  for (const bool given : {true, false}) {
    apsis::time_marcher<double> march(0.0, 1.0, given ? std::optional<double>(0.125) : std::nullopt);
    march.start_up(0.125, 1e-4);
    long total = march.step() + march.steps_left(0.125);
    while (!march.done()) {
      EXPECT_EQ(march.step() + march.steps_left(0.125), total);
      march.advance(march.next(0.125));
    }
    EXPECT_EQ(march.step(), total);
  }
}

using real = long double;
using state = std::array<real, 2>;

double error(const std::string& method, state u, real epsilon, startup how) {
  auto problem = ode_model::as_relaxation<state>(epsilon);
  state exact = u;
  apsis::extrapolate(problem, exact, real(0), real(1), {1e-12L}, [](const state& a, const state& b) {
    return std::max(std::abs(a[0] - b[0]), std::abs(a[1] - b[1]));
  });
  apsis::stepper march(apsis::find_method(method), problem);
  const auto done =
      apsis::integrate(march, u, real(0), real(1), step_rule<real>::fixed(1.0L / 256).with(how));
  EXPECT_EQ(done.t, 1);
  EXPECT_EQ(done.steps, 256 + (done.startup_steps > 0 ? done.startup_steps - 1 : 0));
  // The number follows from log2(4 · 5/(256 ε)) = 9.6 for ε = 1e-4.
  EXPECT_EQ(done.startup_steps, how == startup::graded ? 11 : 0);
  return static_cast<double>(std::abs(u[0] - exact[0]) + std::abs(u[1] - exact[1]));
}

TEST(startup, makes_errors_for_inconsistent_data_as_small_as_for_consistent_data) {
  const real epsilon = 1e-4L, e = std::sin(real(2));
  const state near = {2, e - epsilon * std::cos(real(2)) * e / 5}, far = {2, 0};
  const double consistent = error("md-imex-4-2", near, epsilon, startup::none);
  const double resolved = error("md-imex-4-2", far, epsilon, startup::graded);
  const double as_it_is = error("md-imex-4-2", far, epsilon, startup::none);
  EXPECT_LT(resolved, 2 * consistent);
  EXPECT_GT(as_it_is, 10 * resolved);  // without it the layer is not resolved
  EXPECT_LT(10 * consistent, error("md-imex-3-2", near, epsilon, startup::none));
  EXPECT_LT(10 * resolved, error("md-imex-3-2", far, epsilon, startup::none));
  EXPECT_LT(10 * resolved, error("md-imex-3-2", far, epsilon, startup::graded));
}

/// Returns the error on the ODE model with equal steps, and the number of steps. The first step is graded
/// with the given ratio.
std::pair<double, long> graded(const std::string& method, int steps, int growth, real epsilon) {
  auto problem = ode_model::as_relaxation<state>(epsilon);
  state u = {2, 0}, exact = u;
  apsis::extrapolate(problem, exact, real(0), real(1), {1e-13L}, [](const state& a, const state& b) {
    return std::max(std::abs(a[0] - b[0]), std::abs(a[1] - b[1]));
  });
  apsis::stepper march(apsis::find_method(method), problem);
  const auto rule = step_rule<real>::fixed(real(1) / steps).with(startup::graded, growth);
  const auto done = apsis::integrate(march, u, real(0), real(1), rule);
  return {static_cast<double>(std::abs(u[0] - exact[0]) + std::abs(u[1] - exact[1])), done.steps};
}

TEST(startup, a_larger_ratio_saves_methods_of_high_order_half_of_the_steps) {
  // Without grading the error is 3e-8 (ε = 1e-4). A ratio of 4 resolves the layer as well as a ratio of 2,
  // with half of the additional steps.
  const auto [doubling, steps] = graded("extrapolated-euler-7", 6, 2, 1e-4L);
  const auto [coarse, fewer] = graded("extrapolated-euler-7", 6, 4, 1e-4L);
  EXPECT_LT(doubling, 1e-10);
  EXPECT_LT(coarse, 1e-9);
  EXPECT_LE(2 * (fewer - 6), steps - 6);
}

TEST(startup, a_larger_ratio_costs_methods_of_lower_order_accuracy) {
  EXPECT_GT(graded("extrapolated-euler-4", 64, 8, 1e-2L).first,
            10 * graded("extrapolated-euler-4", 64, 2, 1e-2L).first);
}

TEST(startup, takes_one_step_in_the_limit_and_requires_a_relaxation_time) {
  auto limit = ode_model::as_relaxation<state>(0);
  apsis::stepper march(apsis::find_method("md-imex-4-2"), limit);
  state plain = {2, 0}, graded = plain;
  const auto rule = step_rule<real>::fixed(1.0L / 64);
  apsis::integrate(march, plain, real(0), real(1), rule);
  const auto done = apsis::integrate(march, graded, real(0), real(1), rule.with(startup::graded));
  EXPECT_EQ(done.startup_steps, 1);
  EXPECT_EQ(plain, graded);
  auto unknown = ode_model::as_newton<std::vector<double>>(1e-3);
  apsis::stepper other(apsis::find_method("md-imex-4-2"), unknown);
  std::vector<double> u = {2, 0};
  EXPECT_THROW(apsis::integrate(other, u, 0.0, 1.0, step_rule<double>::fixed(1.0 / 64).with(startup::graded)),
               apsis::input_error);
}

TEST(startup, works_in_any_precision) {
  using apsis::mp_real;
  apsis::time_marcher<mp_real> march(mp_real(0), mp_real(1), mp_real(1) / 3);
  march.start_up(mp_real(0), mp_real("1e-20"));
  long steps = 0;
  for (; !march.done(); ++steps) march.advance(march.next(mp_real(0)));
  EXPECT_EQ(steps, 3 + 67);  // ceil(log2(4e20/3))
  EXPECT_EQ(march.t(), mp_real(1));
}

}  // namespace

}  // namespace startup_test
