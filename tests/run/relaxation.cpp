// The relaxation system on a mesh agrees with exact solutions of its limiting conservation laws.
#include "cases.hpp"

#include <apsis/config/case_json.hpp>
#include <apsis/core/errors.hpp>

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace relaxation_test {

namespace {

apsis::simulation finished_run(const std::string& name, const std::vector<std::string>& overrides) {
  apsis::simulation run(apsis::load_case("paper/" + name, overrides));
  finish(run);
  return run;
}

/// Returns the smooth solution u = u₀(x − u t) of u_t + u u_x = 0 with u(0, x) = 0.4 + 0.3 sin πx.
double burgers(double t, double x) {
  double u = 0.4;
  for (int k = 0; k < 50; ++k) {
    const double at = std::numbers::pi * (x - u * t);
    u -= (u - 0.4 - 0.3 * std::sin(at)) / (1.0 + 0.3 * std::numbers::pi * t * std::cos(at));
  }
  return u;
}

}  // namespace

TEST(relaxation, converges_to_burgers_equation_at_the_order_of_the_method) {
  // Point values agree with the solution by characteristics. At Δt ~ Δx third order in time is visible,
  // because the space error is of fifth order.
  const auto error = [](int cells) {
    const auto fields =
        finished_run("relaxation-burgers", {"space.cells=" + std::to_string(cells), "model.epsilon=0",
                                            "time.end=0.5", "space.formulation=finite-difference"})
            .fields();
    double largest = 0.0;
    for (std::size_t i = 0; i < fields.x.size(); ++i)
      largest = std::max(largest, std::abs(fields.values[0][i] - burgers(0.5, fields.x[i])));
    return largest;
  };
  const double coarse = error(160), fine = error(320);
  EXPECT_GT(std::log2(coarse / fine), 2.85);
  EXPECT_LT(fine, 1e-5);
}

TEST(relaxation, a_linear_flux_advects_the_data_with_its_slope) {
  const auto fields =
      finished_run("relaxation", {"model.flux=linear", "model.slope=-0.5", "model.epsilon=1e-10",
                                  "time.end=1", "model.initial=smooth-consistent",
                                  "space.formulation=finite-difference", "space.cells=160"})
          .fields();
  for (std::size_t i = 0; i < fields.x.size(); ++i) {
    const double exact = 0.4 + 0.3 * std::sin(std::numbers::pi * (fields.x[i] + 0.5));
    EXPECT_NEAR(fields.values[0][i], exact, 1e-5);  // third order at Δt = 1/160
    EXPECT_NEAR(fields.values[1][i], -0.5 * exact, 1e-5);
  }
}

TEST(relaxation, buckley_leverett_has_its_shock_at_the_position_of_the_tangent_construction) {
  const auto run = finished_run("relaxation-buckley-leverett", {});
  const auto fields = run.fields();
  // u*² = M/(1 + M). The shock from u* to 0 has the speed F(u*)/u*.
  const double star = std::sqrt(0.5 / 1.5);
  const double F = star * star / (star * star + 0.5 * (1 - star) * (1 - star));
  const double shock = 0.4 * F / star, cell = 0.01;
  for (std::size_t i = 0; i < fields.x.size(); ++i) {
    if (fields.x[i] > shock + 3 * cell) {
      EXPECT_LT(std::abs(fields.values[0][i]), 1e-3) << fields.x[i];
    }
    if (fields.x[i] < shock - 3 * cell) {
      EXPECT_GT(fields.values[0][i], star - 0.01) << fields.x[i];
    }
  }
  EXPECT_TRUE(run.promises().conservation);  // including the flux through the ends
  // Mass enters with the flux F(1) = 1, and none leaves.
  double mass = 0.0;
  for (const double u : fields.values[0]) mass += cell * u;
  EXPECT_NEAR(mass, 0.5 + 0.4, 1e-10);
}

TEST(relaxation, boundaries_named_per_end_equal_one_name_for_both) {
  const std::vector<std::string> both = {"space.cells=60", "time.end=0.1"};
  auto one_by_one = both;
  one_by_one.insert(one_by_one.end(),
                    {"space.boundary=periodic", "boundary.left.kind=outflow", "boundary.right.kind=outflow"});
  const auto a = finished_run("relaxation-buckley-leverett", both),
             b = finished_run("relaxation-buckley-leverett", one_by_one);
  EXPECT_EQ(a.state(), b.state());
  EXPECT_TRUE(b.promises().conservation);
  EXPECT_NE(apsis::to_json(b.config())["boundary"]["left"]["kind"], nullptr);
}

}  // namespace relaxation_test
