// Methods for mixed regimes reduce the errors of size ε where ε ~ Δt.
#include <apsis/design/design_problem.hpp>
#include <apsis/design/draw.hpp>
#include <apsis/method/certificate.hpp>
#include <apsis/method/kinds/two_step.hpp>
#include <apsis/method/method.hpp>
#include <apsis/method/time_integrator.hpp>

#include <cmath>

#include <gtest/gtest.h>

namespace apsis::narrow_bands_test {
namespace {

// Are the errors those of docs/plateaus.md, up to the last digit there?
TEST(narrow_bands, are_as_documented) {
  EXPECT_NEAR(find_certificate("md-imex-8-3-mixed").band.error, 0.0093, 5e-5);
  EXPECT_NEAR(find_certificate("md-imex-8-3-narrow").band.error, 0.00013, 5e-6);
  EXPECT_NEAR(find_certificate("md-imex-9-3-narrow").band.error, 0.00048, 5e-6);
  EXPECT_NEAR(find_certificate("md-imex-10-3-mixed").band.error, 0.0029, 5e-5);
  EXPECT_NEAR(find_certificate("md-imex-10-3-long").band.error, 0.0024, 5e-5);
  EXPECT_NEAR(certify_two_step(*find_integrator("two-step-8-3-narrow").file()).band.error, 0.000022, 5e-7);
  EXPECT_NEAR(certify_two_step(*find_integrator("two-step-10-3-mixed").file()).band.error, 0.00077, 5e-6);
}

double layer_of(const char* name) {
  const method& m = find_method(name);
  design_task task;
  task.stages = m.stages();
  task.demands.order = m.claims.order;
  task.demands.regime = regime_demand::all;
  const auto form = m.coefficients<double>();
  design_problem problem(pattern_near(task, form), task.demands);
  return std::sqrt(2.0 * problem.half_square(design_problem::measure::layer, problem.unknowns_of(form)));
}

// Only the objective `mixed` contains the errors in layers and of the deviation from equilibrium.
TEST(narrow_bands, come_with_small_errors_in_layers_for_one_method) {
  const double least = layer_of("md-imex-10-3-mixed");
  for (const char* other : {"md-imex-8-3-mixed", "md-imex-8-3-narrow", "md-imex-9-3-narrow"})
    EXPECT_LT(least, 0.3 * layer_of(other)) << other << ": " << least << " " << layer_of(other);
}

}  // namespace
}  // namespace apsis::narrow_bands_test
