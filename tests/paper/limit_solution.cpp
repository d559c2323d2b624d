// Runs with ε = 0 agree with the limit systems written out by hand.
#include <paper/limit_solution.hpp>

#include <apsis/core/errors.hpp>
#include <apsis/model/model_registry.hpp>
#include <apsis/run/setup.hpp>
#include <apsis/study/model_properties.hpp>

#include <cmath>

#include <gtest/gtest.h>
#include <paper/limit_equations.hpp>
#include <study/limit_cases.hpp>

namespace limit_solution_test {

using namespace apsis;
using namespace apsis::paper;

namespace {

/// Compares the moments of transported equilibria, at the data of the case, with the written system.
void expect_same(const case_config& config) {
  const auto system = written_limit(config);
  ASSERT_TRUE(system.has_value());
  const run_setup setup(config);
  const auto& equation = dynamic_cast<const relaxation_model&>(*setup.equation);
  const field data = setup.initial_state();
  std::vector<double> omega(static_cast<std::size_t>(equation.moment_count())), expected(omega.size(), 0.0),
      got(omega.size());
  std::vector<double> e(static_cast<std::size_t>(equation.components())), moved(e.size(), 0.0);
  for (int i = 0; i < data.cells(); ++i) {
    equation.moments(data.row(i), omega.data());
    ASSERT_TRUE(equation.equilibrium(omega.data(), e.data()));
    if (equation.space_dimensions() > 0)
      for (std::size_t k = 0; k < e.size(); ++k) moved[k] = equation.speeds(0)[k] * e[k];
    if (equation.has_source()) equation.source(e.data(), moved.data());
    equation.moments(moved.data(), got.data());
    (system->flux ? system->flux : system->source)(omega.data(), expected.data());
    for (std::size_t k = 0; k < omega.size(); ++k)
      // The midpoint rule over velocities is exact up to rounding. Energy fluxes sum terms of size 10.
      EXPECT_NEAR(got[k], expected[k], 1e-12) << config.model.name << ", moment " << k << ", cell " << i;
  }
}

}  // namespace

// A misprint in the written systems or in the models fails here.
TEST(limit_equations, are_the_moments_of_transported_equilibria) {
  int written = 0;
  for (const auto& name : relaxation_model_names()) {
    const case_config config = apsis::small_case(name);
    if (!written_limit(config)) continue;
    ++written;
    expect_same(config);
  }
  EXPECT_GE(written, 4);  // those of the paper
  for (const std::string flux : {"linear", "buckley-leverett"})
    expect_same(apsis::small_case("relaxation", {"model.flux=" + flux, "model.speed=3"}));
  EXPECT_FALSE(written_limit(apsis::small_case("relaxation", {"model.flux=sin(u)/2"})).has_value());
}

TEST(limit_equations, of_a_gas_with_three_velocity_dimensions_has_gamma_five_thirds) {
  const auto system =
      written_limit(apsis::small_case("bgk", {"model.velocity_dimensions=3", "velocity.points=20"}));
  // For ρ = 2, u = (1, ½, 0) and p = 3, 𝓔 = 3p/2 + ½ρ|u|².
  const double omega[5] = {2.0, 2.0, 1.0, 0.0, 4.5 + 1.25};
  double flux[5];
  system->flux(omega, flux);
  EXPECT_NEAR(flux[0], 2.0, 1e-15);
  EXPECT_NEAR(flux[1], 2.0 + 3.0, 1e-14);
  EXPECT_NEAR(flux[2], 1.0, 1e-14);
  EXPECT_EQ(flux[3], 0.0);
  EXPECT_NEAR(flux[4], 5.75 + 3.0, 1e-14);
}

TEST(limit_solution, is_met_in_the_order_of_the_method) {
  // One halving on meshes where the temporal error of the second-order method dominates. Claim C17 covers
  // further meshes.
  const std::vector<std::string> common = {"time.method=md-imex-3-2", "space.reconstruction=weno5-z"};
  const auto error = [&](const char* cells, const fourier_solution* solution) {
    auto overrides = common;
    overrides.push_back(std::string("space.cells=") + cells);
    const auto config = load_case("paper/broadwell", overrides);
    return distance_from_limit_solution(config, *solution);
  };
  const auto solution = limit_solution(load_case("paper/broadwell"), 129, 400);
  EXPECT_LT(solution.resolution(), 1e-13);
  EXPECT_NEAR(std::log2(error("80", &solution) / error("160", &solution)), 2.0, 0.1);
}

TEST(limit_solution, needs_a_written_limit_and_a_riemann_problem) {
  EXPECT_THROW(limit_solution(load_case("paper/decay")), input_error);
  EXPECT_THROW(compare_with_riemann_solution(load_case("paper/broadwell")), input_error);
  EXPECT_THROW(compare_with_riemann_solution(load_case("paper/ode")), input_error);
}

}  // namespace limit_solution_test
