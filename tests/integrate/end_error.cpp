// Tolerances that become smaller until the error at the end is small: the law of the factors, and its
// estimate against exact errors of the production stepper.
#include <apsis/integrate/end_error.hpp>

#include <apsis/integrate/component_tolerances.hpp>
#include <apsis/integrate/evolution.hpp>
#include <apsis/integrate/newton_problem.hpp>
#include <apsis/method/method.hpp>

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>
#include <integrate/random.hpp>
#include <support/bad_input.hpp>
#include <support/property.hpp>

namespace end_error_test {
namespace {

using random_input::magnitude;
using random_input::uniform;
using row = std::vector<double>;

double distance(double a, double b) {
  return std::abs(a - b);
}

TEST(end_error, estimates_are_not_below_errors_that_decrease_as_a_power_of_the_tolerance) {
  check_property("error C f^k, k from 1/2 to 2", [] {
    const double exact = uniform(-1, 1), size = magnitude(-3, 4), power = uniform(0.5, 2);
    std::vector<double> factors;
    const auto found = apsis::refine_until_accurate(
        [&](double factor) {
          factors.push_back(factor);
          return exact + size * std::pow(factor, power);
        },
        distance, 1e-12, 20);
    const double error = std::abs(found.solution - exact);
    RC_ASSERT(error <= found.error * (1 + 1e-9) + 1e-15);  // rounding of `exact`
    RC_ASSERT(found.error <= 1.0);
    RC_ASSERT(found.runs == static_cast<int>(factors.size()) && found.factor == factors.back());
    for (std::size_t k = 1; k < factors.size(); ++k)
      RC_ASSERT(factors[k] <= 0.1 * factors[k - 1] * (1 + 1e-15));
  });
}

TEST(end_error, two_runs_suffice_for_small_errors) {
  const auto found = apsis::refine_until_accurate([](double factor) { return 0.1 * factor; }, distance);
  EXPECT_EQ(found.runs, 2);
  EXPECT_EQ(found.factor, 0.1);
}

TEST(end_error, results_that_do_not_converge_are_refused) {
  int runs = 0;
  const auto chaotic = [&](double) { return std::fmod(++runs * 997.0, 100.0); };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  bad_input::expect_refused({
      {[&] { apsis::refine_until_accurate(chaotic, distance); },
       {"the error at the end is not within the tolerances", "enlarge the tolerances, or end earlier"},
       3},
      {[&] { apsis::refine_until_accurate([](double) { return 0.0; }, [&](double, double) { return nan; }); },
       {"the error at the end is not within the tolerances", "nan"},
       3},
  });
  EXPECT_LE(runs, 8);
}

TEST(end_error, is_that_of_an_oscillation_whose_steps_add_their_errors) {
  const auto field = [](const auto& u, auto& out) {
    out[0] = 2.0 * std::numbers::pi * u[1];
    out[1] = -2.0 * std::numbers::pi * u[0];
  };
  for (const char* name : {"ark-437", "ark-548-2", "extrapolated-euler-5"}) {
    const apsis::component_tolerances<double> wanted(1e-5, 1e-5);
    const auto solve = [&](double factor) {
      const apsis::component_tolerances<double> used(1e-5 * factor, 1e-5 * factor);
      apsis::newton_problem problem(apsis::no_transport{}, field);
      problem.with_tolerances(used);
      apsis::evolution march(apsis::find_method(name), problem, apsis::step_rule<double>::unlimited(),
                             apsis::step_tolerance<row, double>{1.0, used, {}, "predictive"});
      march.start(0.0, row{1.0, 0.0});
      march.advance(50.0);
      return march.u();
    };
    const row exact{1.0, 0.0};
    const auto found = apsis::refine_until_accurate(solve, wanted);
    EXPECT_GT(wanted(solve(1.0), exact), 1.0) << name;  // steps alone do not suffice
    EXPECT_LE(wanted(found.solution, exact), found.error) << name;
    EXPECT_LE(found.error, 1.0) << name;
  }
}

}  // namespace
}  // namespace end_error_test
