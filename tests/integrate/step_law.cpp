// The laws of step_law.hpp: their formula, the step at which they settle, and the oscillations
// that they damp.
#include <apsis/core/errors.hpp>
#include <apsis/integrate/any_march.hpp>
#include <apsis/integrate/error_control.hpp>
#include <apsis/integrate/relaxation_problem.hpp>
#include <apsis/method/method.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace step_law_test {

namespace {

using apsis::step_controller;
using testing::HasSubstr;

double random_number(double low, double high) {
  return low + (high - low) * *rc::gen::inRange(0, 1 << 30) / static_cast<double>(1 << 30);
}

std::string any_law() {
  return *rc::gen::elementOf(apsis::step_law_names());
}

/// Length and estimated error of an accepted step.
struct past_step {
  double dt, error;
};

/// Returns ln Δt_{n+1} for the last steps, oldest first, as a sum of logarithms.
double log_of_next(const apsis::step_law& law, const std::vector<past_step>& past, double tolerance,
                   double k) {
  const auto log_factor = [&](std::size_t back) {
    if (back >= past.size()) return 0.0;
    return std::log(0.9) + std::log(tolerance / past[past.size() - 1 - back].error) / k;
  };
  const auto log_length = [&](std::size_t back) { return std::log(past[past.size() - 1 - back].dt); };
  const double trend = past.size() > 1 ? log_length(0) - log_length(1) : 0.0;
  if (law.predictive) {
    const double slope = past.size() > 1 ? trend + log_factor(0) - log_factor(1) : 0.0;
    return log_length(0) + log_factor(0) + std::min(slope, 0.0);
  }
  double sum = log_length(0) - law.alpha * trend;
  for (std::size_t back = 0; back < 3; ++back) sum += law.beta[back] * log_factor(back);
  return sum;
}

}  // namespace

RC_GTEST_PROP(step_law, the_controller_follows_its_formula, ()) {
  const auto& law = apsis::find_step_law(any_law());
  const int order = *rc::gen::inRange(1, 6);
  const double tolerance = std::pow(10.0, random_number(-9, -2)), k = order + 1;
  step_controller<double> control(tolerance, order, law);
  std::vector<past_step> past;
  const auto count = *rc::gen::inRange<std::size_t>(1, 6);
  for (std::size_t n = 0; n < count; ++n) {
    // The errors are so near the tolerance that no limit of the change of a step is active.
    const past_step one{random_number(0.9, 1.0), tolerance * std::pow(random_number(0.85, 1.0), k)};
    past.push_back(one);
    RC_ASSERT(control.accepts(one.dt, one.error));
  }
  // Powers of doubles have rounding errors of some ulp.
  RC_ASSERT(std::abs(std::log(control.proposed()) - log_of_next(law, past, tolerance, k)) < 1e-13);
}

RC_GTEST_PROP(step_law, every_law_settles_where_a_step_has_its_tolerance_with_safety, ()) {
  const int order = *rc::gen::inRange(1, 9);
  const double k = order + 1, tolerance = std::pow(10.0, random_number(-10, -1)),
               constant = std::pow(10.0, random_number(-3, 3));
  step_controller<double> control(tolerance, order, apsis::find_step_law(any_law()));
  double dt = std::pow(10.0, random_number(-4, 1)) * std::pow(tolerance / constant, 1.0 / k);
  long late_rejections = 0;
  for (int n = 0; n < 400; ++n) {
    if (!control.accepts(dt, constant * std::pow(dt, k)) && n > 50) ++late_rejections;
    dt = control.proposed();
  }
  RC_ASSERT(late_rejections == 0);
  // The slowest law reduces the distance by a ninth in a step.
  RC_ASSERT(std::abs(dt / (0.9 * std::pow(tolerance / constant, 1.0 / k)) - 1.0) < 1e-9);
}

RC_GTEST_PROP(step_law, a_controller_that_is_saved_continues_with_the_same_bits, ()) {
  const auto& law = apsis::find_step_law(any_law());
  step_controller<double> one(1e-4, 2, law), other(1e-4, 2, law);
  const int save_at = *rc::gen::inRange(0, 12);
  for (int n = 0; n < 20; ++n) {
    const double dt = random_number(0.01, 1.0), error = 1e-4 * random_number(0.0, 1.5);
    one.accepts(dt, error);
    if (n < save_at) continue;
    if (n == save_at)
      other.resume(one.save());
    else
      other.accepts(dt, error);
    RC_ASSERT(one.proposed() == other.proposed());
    RC_ASSERT(one.rejected() == other.rejected());
  }
}

TEST(step_law, proportional_terms_avoid_rejections_where_stability_limits_the_step) {
  // u' = −300 (u − cos t) − sin t with u(0) = 1 has the solution u = cos t. The rate −300 limits the steps of
  // an explicit method.
  using state = std::vector<double>;
  const auto rejections = [](const char* law) {
    auto p = apsis::make_relaxation_problem<state>(
        [](double t, const state& u, state& out) { out[0] = -300.0 * (u[0] - std::cos(t)) - std::sin(t); },
        [](const state& u) { return u[0]; }, [](double w, state& out) { out[0] = w; },
        [](double) { return 0.0; }, 1.0);
    const auto& m = apsis::find_method("dop853");
    apsis::stepper march(m, p, apsis::solutions::result_and_embedded);
    step_controller<double> control(1e-5, apsis::estimate_of(m).order, apsis::find_step_law(law));
    state u{1.0};
    apsis::integrate_to_tolerance(march, u, 0.0, 10.0, apsis::step_rule<double>::unlimited(), control,
                                  [](const state& a, const state& b) { return std::abs(a[0] - b[0]); });
    EXPECT_NEAR(u[0], std::cos(10.0), 1e-5) << law;
    return control.rejected();
  };
  const long by_last_error = rejections("integral");
  EXPECT_GT(by_last_error, 200);
  for (const char* law : {"pi", "pid", "h211b", "h312pid"})
    EXPECT_LT(2 * rejections(law), by_last_error) << law;
}

TEST(step_law, an_unknown_one_is_refused_with_the_nearest_name) {
  try {
    static_cast<void>(apsis::find_step_law("predictve"));
    FAIL() << "accepted";
  } catch (const apsis::input_error& refused) {
    EXPECT_THAT(refused.what(), HasSubstr("unknown controller 'predictve'"));
    EXPECT_THAT(refused.what(), HasSubstr("did you mean 'predictive'?"));
  }
}

}  // namespace step_law_test
