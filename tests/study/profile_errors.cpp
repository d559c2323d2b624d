// Predicted errors of the O(ε) terms agree with runs of a small mixed-regime problem.
#include <apsis/study/profile_errors.hpp>

#include <apsis/core/errors.hpp>
#include <apsis/study/compare.hpp>
#include <apsis/study/conserved_fields.hpp>

#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <support/bad_input.hpp>

namespace apsis::profile_errors_test {
namespace {

/// Returns the mixed-regime problem of the paper with fewer velocities.
case_config mixed(const std::string& method, double dt, const std::vector<std::string>& overrides = {}) {
  // The limiter would depend on the length of the steps, and the reference has other steps.
  std::vector<std::string> all = {"velocity.max=9", "velocity.points=24", "space.limiter=none",
                                  "time.method=" + method, "time.dt=" + std::to_string(dt)};
  all.insert(all.end(), overrides.begin(), overrides.end());
  return load_case("paper/bgk-mixed-fd", all);
}

/// Returns the l2 norms of the errors of ρ, ρu and 𝓔 of a run. The reference method is bhr-553. Its equal
/// weights for T and Q make its viscosity and its layer exact. With half the step its error is below 1e-2 of
/// those of the tests.
std::vector<double> measured(const case_config& config) {
  case_config fine = config;
  fine.time.method = "bhr-553";
  fine.time.dt = *config.time.dt / 2;
  fine.time.startup = startup_choice::graded;
  const auto run = compute_outcome(config);
  const auto a = conserved(run.fields), b = conserved(compute_outcome(fine).fields);
  std::vector<double> errors;
  for (std::size_t k = 0; k < a.size(); ++k) {
    double sum = 0.0;
    for (std::size_t i = 0; i < a[k].size(); ++i) sum += (a[k][i] - b[k][i]) * (a[k][i] - b[k][i]);
    errors.push_back(std::sqrt(sum * run.cell_volume));
  }
  return errors;
}

void expect_prediction(const case_config& config, double tolerance) {
  const auto predicted = predict_profile_errors(config, 0);
  ASSERT_EQ(predicted.rows.size(), 1U);
  EXPECT_THAT(predicted.invariants, testing::ElementsAre("mass", "momentum", "energy"));
  EXPECT_DOUBLE_EQ(predicted.rows[0].dt, *config.time.dt);
  const auto errors = measured(config);
  for (std::size_t k = 0; k < errors.size(); ++k)
    EXPECT_NEAR(predicted.rows[0].of_moments[k] / errors[k], 1.0, tolerance)
        << config.time.method << " " << predicted.invariants[k] << ": predicted "
        << predicted.rows[0].of_moments[k] << ", measured " << errors[k];
}

// Terms O(Δt²) and the error O(Δt³) of the transport are not predicted. At these steps they are at most 2 %.
constexpr double next_order = 0.03;

TEST(profile_errors, are_those_of_runs_with_a_graded_start) {
  expect_prediction(mixed("md-imex-8-3", 1.0 / 2000, {"time.startup=graded"}), next_order);
}

TEST(profile_errors, include_an_initial_layer_that_no_step_resolves) {
  expect_prediction(mixed("md-imex-6-3", 1.0 / 2000), next_order);
}

TEST(profile_errors, depend_on_the_collision_rate_of_the_solution) {
  expect_prediction(
      mixed("md-imex-6-3", 1.0 / 2000, {"model.collision_rate=viscosity", "model.viscosity_exponent=0.8"}),
      2 * next_order);  // C changes by a fifth during the run
}

TEST(SLOW_profile_errors, are_those_of_runs_with_a_narrow_band) {
  expect_prediction(mixed("md-imex-8-3-mixed", 1.0 / 8000, {"time.startup=graded"}), next_order);
  expect_prediction(mixed("md-imex-8-3-mixed", 1.0 / 8000), 2 * next_order);  // 10 times smaller errors
}

TEST(profile_errors, of_a_method_without_viscosity_halve_with_the_step) {
  // md-imex-3-2 has flux(z) = 0 for z → ∞. With shorter steps CΔt/ε is large in fewer cells.
  const auto table = predict_profile_errors(mixed("md-imex-3-2", 1.0 / 1000, {"time.end=0.1"}), 3);
  ASSERT_EQ(table.rows.size(), 4U);
  EXPECT_NEAR(table.smallest_epsilon, 1e-5, 2e-6);
  for (std::size_t k = 1; k < table.rows.size(); ++k) {
    EXPECT_DOUBLE_EQ(table.rows[k].dt, 0.001 / std::pow(2.0, k));
    EXPECT_LT(table.rows[k].of_moments[0], table.rows[k - 1].of_moments[0]);
    EXPECT_GT(table.rows[k].least_flux, table.rows[k - 1].least_flux);
  }
  EXPECT_LT(table.rows[0].least_flux, 0.05);
  EXPECT_NEAR(table.rows[0].largest_flux, 1.0, 1e-4);  // where epsilon is of order one
}

TEST(profile_errors, vanish_where_transport_and_collision_have_the_same_weights) {
  const auto table =
      predict_profile_errors(mixed("bhr-553", 1.0 / 1000, {"time.end=0.1", "time.startup=graded"}), 0);
  // The difference of R(−z)^N and e^{−CT/ε} remains where ε is of the order of T. md-imex-6-3 has 4e-5.
  for (const double error : table.rows[0].of_moments) EXPECT_LT(error, 1e-8);
}

void expect_refusal(const case_config& config, const std::string& reason) {
  bad_input::expect_refused({{[&] { predict_profile_errors(config, 0); }, {reason}}});
}

TEST(profile_errors, are_refused_where_the_theory_does_not_apply) {
  expect_refusal(mixed("ssprk-3-3", 1e-6), "it is no IMEX method");
  expect_refusal(mixed("md-imex-6-3", 1e-3, {"time.tolerance=1e-3"}), "time.tolerance changes it");
  expect_refusal(load_case("paper/ode", {}), "the O(epsilon) terms of model 'ode' cannot be predicted");
}

}  // namespace
}  // namespace apsis::profile_errors_test
