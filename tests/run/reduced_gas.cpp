// Runs of a gas with more degrees of freedom than velocity dimensions.
#include <apsis/config/case.hpp>
#include <apsis/run/session.hpp>
#include <apsis/run/setup.hpp>
#include <apsis/run/simulation.hpp>

#include <cmath>
#include <functional>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <support/shock_tube.hpp>

namespace reduced_gas_test {

namespace {

using apsis::parse_case;
using apsis::simulation;
using test_support::shock_tube;

/// Returns density, velocity and temperature after a run, [field][cell].
std::vector<std::vector<double>> fields_after(const std::string& text,
                                              const std::vector<std::string>& overrides) {
  const auto config = parse_case(text, "c.toml", overrides);
  simulation run(config);
  while (!run.finished()) run.advance();
  const apsis::run_setup setup(config);
  std::vector<double> values(setup.equation->default_fields().size());
  std::vector<std::vector<double>> out(values.size());
  const auto state = run.state();
  const std::size_t width = state.size() / static_cast<std::size_t>(run.mesh().size());
  for (std::size_t cell = 0; cell < static_cast<std::size_t>(run.mesh().size()); ++cell) {
    setup.equation->macroscopic(state.data() + cell * width, values.data());
    for (std::size_t k = 0; k < values.size(); ++k) out[k].push_back(values[k]);
  }
  return out;
}

}  // namespace

TEST(reduced_gas, agrees_with_a_gas_whose_velocities_are_all_resolved) {
  const std::string text =
      "[model]\nname = \"bgk\"\ndegrees_of_freedom = 3\nepsilon = \"0.01 + 0.5*x\"\n"
      "[initial]\nrho = \"1 + 0.3*sin(pi*x)\"\nu = 0.4\nT = \"1 - 0.2*cos(pi*x)\"\n"
      "[space]\ncells = 8\ndomain = [0.0, 2.0]\nreconstruction = \"upwind1\"\n[velocity]\nmax = 8\npoints = "
      "20\n"
      "[time]\nmethod = \"md-imex-6-3\"\nend = 0.2\ndt = 0.02\n";
  for (const char* rate : {"constant", "viscosity"}) {
    const std::string option = std::string("model.collision_rate=") + rate;
    const auto full = fields_after(text, {option, "model.velocity_dimensions=3"});
    for (const int d : {1, 2}) {
      const auto reduced = fields_after(text, {option, fmt::format("model.velocity_dimensions={}", d)});
      const std::size_t T = static_cast<std::size_t>(d) + 1;
      for (std::size_t cell = 0; cell < 8; ++cell) {
        // Linear reconstructions commute with the integral over unresolved components. The reduction is thus
        // exact up to the midpoint rule over these components: Δv = 0.8, T ≥ 0.8, exp(−2π² T/Δv²) = 2e-11.
        EXPECT_NEAR(reduced[0][cell], full[0][cell], 1e-9) << d << rate;
        EXPECT_NEAR(reduced[1][cell], full[1][cell], 1e-9) << d << rate;
        EXPECT_NEAR(reduced[T][cell], full[4][cell], 1e-9) << d << rate;
      }
    }
  }
}

TEST(reduced_gas, becomes_a_perfect_gas_with_its_ratio_of_specific_heats) {
  const std::string text =
      "[model]\nname = \"bgk\"\nepsilon = 0\n"
      "[initial]\nrho = 1\nT = 1\n[[initial.region]]\nwhere = \"x > 0\"\nrho = 0.125\nT = 0.8\n"
      "[space]\ncells = 200\ndomain = [-0.5, 0.5]\nboundary = \"outflow\"\nlimiter = \"positivity\"\n"
      "formulation = \"finite-difference\"\n[velocity]\nmax = 7\npoints = 32\n"
      "[time]\nmethod = \"md-imex-3-2\"\nend = 0.15\nsafety = 1\n";
  for (const int D : {1, 3, 5}) {
    const double gamma = (D + 2.0) / D;
    const auto rho = fields_after(text, {fmt::format("model.degrees_of_freedom={}", D)})[0];
    const shock_tube right(gamma, 1.0, 1.0, 0.125, 0.1),
        wrong(gamma == 3.0 ? 5.0 / 3.0 : gamma + 0.1, 1.0, 1.0, 0.125, 0.1);
    double error = 0.0, of_wrong = 0.0;
    for (std::size_t cell = 0; cell < 200; ++cell) {
      const double xi = ((static_cast<double>(cell) + 0.5) / 200 - 0.5) / 0.15;
      error += std::abs(rho[cell] - right.density(xi)) / 200;
      of_wrong += std::abs(rho[cell] - wrong.density(xi)) / 200;
    }
    // A shock and a contact with jumps of 0.1 to 0.25 are captured within some three cells of 1/200 each.
    EXPECT_LT(error, 4e-3) << D;
    EXPECT_LT(2.0 * error, of_wrong) << D;
  }
}

TEST(reduced_gas, has_the_collision_rate_of_its_viscosity) {
  apsis::model_config config = apsis::default_config(apsis::find_model("bgk"));
  config.parameters["degrees_of_freedom"] = 3;
  config.parameters["viscosity_exponent"] = 0.81;
  config.options["collision_rate"] = "viscosity";
  const auto gas = apsis::find_model("bgk").make(config);
  const auto* relaxation = dynamic_cast<const apsis::relaxation_model*>(gas.get());
  ASSERT_NE(relaxation, nullptr);
  const double rho = 1.7, u = 0.3, T = 2.5;
  const double omega[] = {rho, rho * u, 0.5 * rho * (u * u + 3.0 * T)};
  EXPECT_NEAR(relaxation->rate(omega), rho * std::pow(T, 0.19), 1e-14);
  const double vacuum[] = {0.0, 0.0, 0.0};
  EXPECT_EQ(relaxation->rate(vacuum), 0.0);
}

TEST(reduced_gas, keeps_its_promises_on_random_cases) {
  for (const char* epsilon : {"0", "1e-6", "0.1", "1e12"})
    for (const char* formulation : {"finite-volume", "finite-difference"}) {
      const auto config = parse_case(
          "[model]\nname = \"bgk\"\ndegrees_of_freedom = 3\ncollision_rate = \"viscosity\"\n"
          "[initial]\nrho = 1\nT = 0.3\n[[initial.region]]\nwhere = \"x > 0.7 && x < 1.3\"\nrho = 1e-3\nT = "
          "1.5\n"
          "[space]\ncells = 16\ndomain = [0.0, 2.0]\nlimiter = \"positivity\"\n[velocity]\nmax = 9\npoints = "
          "40\n"
          "[time]\nmethod = \"md-imex-6-3\"\nend = 0.05\nsafety = 1\n",
          "c.toml",
          {std::string("model.epsilon=") + epsilon, std::string("space.formulation=") + formulation});
      simulation run(config);
      EXPECT_TRUE(run.promises().positivity);
      EXPECT_TRUE(run.promises().conservation);
      while (!run.finished()) run.advance();  // throws where a promise is broken
      EXPECT_EQ(run.summary().negative_values, 0);
    }
}

}  // namespace reduced_gas_test
