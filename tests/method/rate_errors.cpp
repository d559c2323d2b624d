// Errors of the O(ε) terms at every z = CΔt/ε, and their interpolation in 1/(1 + z).
#include <apsis/method/rate_errors.hpp>

#include "support/catalogue.hpp"

#include <apsis/method/time_integrator.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

namespace rate_errors_test {

namespace {

double value(const std::array<double, apsis::rate_response::terms>& c, double s) {
  double sum = 0.0;
  for (std::size_t k = c.size(); k-- > 0;) sum = sum * s + c[k];
  return sum;
}

class errors_at_rates : public testing::TestWithParam<std::string> {};

}  // namespace

TEST_P(errors_at_rates, have_the_limits_of_the_intermediate_regime) {
  const apsis::method& m = apsis::find_method(GetParam());
  const auto limit = apsis::analyse_intermediate_regime(m.coefficients<double>());
  const double z = 1e7;
  const auto at = apsis::rate_errors_at(m, z);
  // Stages with small d + |ḋ| approach the limit slowly, with terms of relative size 1e3/z.
  EXPECT_NEAR(at.flux, limit.flux - 1.0, 1e-3 * (1.0 + std::abs(limit.flux)));
  EXPECT_NEAR(at.last, limit.last - 1.0, 1e-3 * (1.0 + std::abs(limit.last)));
  if (std::isfinite(limit.layer)) {
    EXPECT_NEAR(at.layer * z, limit.layer - 1.0, 1e-3 * (1.0 + std::abs(limit.layer)));
  }
}

TEST_P(errors_at_rates, are_interpolated_to_a_quarter_of_the_largest) {
  const apsis::method& m = apsis::find_method(GetParam());
  const auto fit = apsis::compute_rate_response(m);
  ASSERT_TRUE(fit);
  double flux = 0.0, last = 0.0, flux_defect = 0.0, last_defect = 0.0;
  for (double z = 1e-2; z < 1e7; z *= 1.3) {
    const auto at = apsis::rate_errors_at(m, z);
    const double s = 1.0 / (1.0 + z);
    flux = std::max(flux, std::abs(at.flux));
    last = std::max(last, std::abs(at.last));
    flux_defect = std::max(flux_defect, std::abs((1.0 - s) * value(fit->flux, s) - at.flux));
    last_defect = std::max(last_defect, std::abs((1.0 - s) * value(fit->last, s) - at.last));
  }
  // Small d + ḋ make responses that are no polynomials of s where s is small. A warning needs only their
  // size. A twentieth of an error of the flux makes a method unfit (judge_loss).
  EXPECT_LE(flux_defect, 0.25 * flux + 0.03);
  EXPECT_LE(last_defect, 0.25 * last + 0.15);
}

INSTANTIATE_TEST_SUITE_P(catalogue, errors_at_rates, testing::ValuesIn(methods_with_an_intermediate_regime()),
                         test_name);

TEST(errors_of_other_integrators, are_those_of_their_equations) {
  // e^{−z} leaves no deviation, so the limit has no flux. For small z the error has the order of the method.
  const apsis::method& exponential = apsis::find_method("exponential-2");
  EXPECT_NEAR(apsis::rate_errors_at(exponential, 1e4).flux, -1.0, 1e-12);
  const double coarse = apsis::rate_errors_at(exponential, 0.02).flux,
               fine = apsis::rate_errors_at(exponential, 0.01).flux;
  EXPECT_GT(std::log2(std::abs(coarse / fine)), 1.9);
  // Formulas of backward differentiation and general linear methods are exact for a constant deviation.
  for (const char* name : {"imex-bdf-2", "imex-bdf-5", "imex-dimsim-3"})
    for (const double z : {0.1, 10.0, 1e6}) {
      const auto at = apsis::find_integrator(name).errors_at(z);
      EXPECT_EQ(at.flux, 0.0) << name;
      EXPECT_EQ(at.last, 0.0) << name;
    }
  const auto two_step = apsis::find_integrator("two-step-10-3-mixed").errors_at(1e6);
  EXPECT_NEAR(two_step.flux, 0.0, 1e-4);
  // Explicit methods have a response within their stability limit. The limit of the second-order method is 2.
  EXPECT_TRUE(std::isfinite(apsis::rate_errors_at(apsis::find_method("ssprk-2-2"), 1.9).flux));
  EXPECT_FALSE(std::isfinite(apsis::rate_errors_at(apsis::find_method("ssprk-2-2"), 2.1).flux));
  EXPECT_FALSE(apsis::compute_rate_response("ssprk-2-2"));
  EXPECT_FALSE(apsis::compute_rate_response("imdrk-2-3"));
  EXPECT_TRUE(apsis::compute_rate_response("exponential-2"));
}

}  // namespace rate_errors_test
