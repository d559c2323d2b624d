// The Broadwell model on a mesh keeps its promises. Its Riemann problems agree with the limit equations.
#include "cases.hpp"

#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

namespace broadwell_test {

namespace {

apsis::case_config case_of(const std::string& name, const std::vector<std::string>& overrides = {}) {
  return apsis::load_case("paper/" + name, overrides);
}

double sum(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

}  // namespace

TEST(broadwell, keeps_positivity_conservation_and_entropy_decay_for_any_epsilon) {
  for (const char* method : {"md-imex-3-2", "md-imex-6-3"})
    for (const char* epsilon : {"0", "1e-8", "1e-3", "1", "1e6"})
      for (const char* scheme : {"upwind1", "weno5-z"}) {
        apsis::simulation run(case_of(
            "broadwell",
            {std::string("time.method=") + method, std::string("model.epsilon=") + epsilon,
             std::string("space.reconstruction=") + scheme, "space.limiter=positivity", "time.safety=1"}));
        EXPECT_TRUE(run.promises().positivity);
        EXPECT_TRUE(run.promises().conservation);
        EXPECT_EQ(run.promises().entropy, std::string(scheme) == "upwind1");
        finish(run);  // a broken promise throws
        EXPECT_EQ(run.summary().negative_values, 0);
      }
}

TEST(broadwell, averages_of_cells_cut_by_a_jump_are_exact) {
  const apsis::simulation run(case_of("broadwell-riemann-1", {"space.cells=25"}));
  const auto fields = run.fields();
  // Cell 14 is [0.12, 0.2] up to rounding, and cell 15 begins at the jump. With 16 cells the jump is inside
  // cell 9.
  const double left[] = {2.0, 1.0, 1.0}, right[] = {1.0, 0.13962, 1.0};
  const apsis::simulation cut(case_of("broadwell-riemann-1", {"space.cells=16"}));
  const auto with_cut = cut.fields();
  const double share = (0.2 - 0.125) / 0.125;  // share of cell 9, [0.125, 0.25]
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(fields.values[k][14], left[k], 1e-14);
    EXPECT_NEAR(fields.values[k][15], right[k], 1e-14);
    EXPECT_NEAR(with_cut.values[k][9], share * left[k] + (1.0 - share) * right[k], 1e-14);
  }
}

TEST(broadwell, the_first_riemann_problem_becomes_one_shock_at_the_speed_of_the_limit) {
  // Rankine–Hugoniot: s = [m]/[ρ]. The total mass determines the position of the shock. It changes by the
  // flux through the ends, m_left − m_right per unit of time.
  for (const auto how : {"finite-volume", "finite-difference"}) {
    auto c = case_of("broadwell-riemann-1", {"space.cells=100", "model.epsilon=1e-8"});
    c.space.discretization = how;
    apsis::simulation run(c);
    EXPECT_TRUE(run.promises().positivity);
    EXPECT_TRUE(run.promises().conservation);  // including the inflow on the left
    EXPECT_FALSE(run.promises().entropy);
    finish(run);
    EXPECT_EQ(run.summary().negative_values, 0);
    const auto fields = run.fields();
    const double shock = 0.2 + 0.5 * (1.0 - 0.13962);
    // The shock is where ρ crosses the mean of both sides. It is captured within two cells of 0.02.
    std::size_t i = 0;
    while (fields.values[0][i] > 1.5) ++i;
    EXPECT_NEAR(fields.x[i], shock, 0.03);
    // The momentum flux on either side is that of local equilibrium. The data had z = 1.
    EXPECT_NEAR(fields.values[2].front(), 1.25, 1e-6);
    EXPECT_NEAR(fields.values[2].back(), (1.0 + 0.13962 * 0.13962) / 2.0, 1e-6);
    const double mass = sum(fields.values[0]) * 0.02;
    const double expected = 2.0 * (1.0 + shock) + 1.0 * (1.0 - shock);
    EXPECT_NEAR(mass, expected, 2e-3);  // O(ε) from the initial layer, O(Δx) from point values
  }
}

TEST(broadwell, negative_data_disable_the_promise_of_positivity_and_become_positive_after_one_step) {
  apsis::simulation run(case_of("broadwell-riemann-2"));
  EXPECT_EQ(run.initial_record().negative_values, 100);
  EXPECT_NEAR(run.initial_record().min_value, -0.4, 1e-15);
  EXPECT_FALSE(run.promises().positivity);
  run.advance();
  EXPECT_EQ(run.last().negative_values, 0) << run.last().min_value;
  EXPECT_GT(run.last().min_value, 0.0);
  // With ε = 1 collisions are slow, so f₀ stays negative for a while.
  apsis::simulation slow(case_of("broadwell-riemann-2", {"model.epsilon=1"}));
  slow.advance();
  EXPECT_GT(slow.last().negative_values, 0);
}

}  // namespace broadwell_test
