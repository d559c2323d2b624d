// Runs with a force: exact solutions of the momentum, order in time, balances.
#include <apsis/config/case.hpp>
#include <apsis/core/errors.hpp>
#include <apsis/run/setup.hpp>
#include <apsis/run/simulation.hpp>

#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace force_test {

namespace {

using apsis::simulation;

/// A uniform periodic gas whose molecules all have the same acceleration.
const std::string accelerated_gas = R"toml(
title = "Accelerated gas"
[parameters]
a = 0.5
[model]
name = "bgk"
degrees_of_freedom = 3
epsilon = 0.01
[initial]
rho = 1
T = 1
[force]
acceleration = "a*cos(2*t)"
[space]
cells = 8
formulation = "finite-difference"
[velocity]
max = 8
points = 32
[time]
method = "md-imex-8-3-mixed"
dt = 0.01
end = 0.8
)toml";

simulation run_of(const std::vector<std::string>& overrides) {
  simulation run(apsis::parse_case(accelerated_gas, "force.toml", overrides));
  while (!run.finished()) run.advance();
  return run;
}

double velocity_after(const std::vector<std::string>& overrides) {
  const simulation run = run_of(overrides);
  const auto fields = run.fields();
  return fields.values.at(1).front();
}

}  // namespace

TEST(accelerated_gas, moves_with_the_integral_of_the_acceleration) {
  // ∫ a cos 2t = (a/2) sin 2t whatever ε is; the rest of order 3 at Δt = 0.01, and the mass beyond the grid.
  for (const char* epsilon :
       {"model.epsilon=0", "model.epsilon=1e-6", "model.epsilon=0.01", "model.epsilon=1e12"})
    EXPECT_NEAR(velocity_after({epsilon}), 0.25 * std::sin(1.6), 1e-7) << epsilon;
}

TEST(accelerated_gas, has_the_order_of_the_method_in_time) {
  const auto error = [](const std::string& dt) {
    return std::abs(velocity_after({"time.dt=" + dt, "velocity.points=48"}) - 0.25 * std::sin(1.6));
  };
  EXPECT_NEAR(std::log2(error("0.08") / error("0.04")), 3.0, 0.2);
}

TEST(accelerated_gas, is_a_shifted_maxwellian_without_collisions) {
  // f(t, v) = M(v − ∫a); of fifth order in Δv.
  const auto error = [](const std::string& points) {
    const simulation run =
        run_of({"model.epsilon=1e12", "velocity.points=" + points, "force.acceleration=0.5"});
    const double spacing = 16.0 / std::stod(points);
    double largest = 0.0;
    for (std::size_t k = 0; k < static_cast<std::size_t>(std::stoi(points)); ++k) {
      const double v = -8.0 + spacing * (static_cast<double>(k) + 0.5), c = v - 0.4;
      largest = std::max(largest, std::abs(run.state()[k] - std::exp(-0.5 * c * c) / std::sqrt(2.0 * M_PI)));
    }
    return largest;
  };
  EXPECT_NEAR(std::log2(error("40") / error("80")), 5.0, 0.3);
}

TEST(accelerated_gas, has_balances_to_rounding) {
  const simulation run = run_of({"space.limiter=positivity"});
  EXPECT_EQ(run.setup().open_faces(), std::vector<std::string>{"force"});
  EXPECT_LE(run.summary().conservation_defect, 1e-13);
  EXPECT_EQ(run.summary().negative_values, 0);
  // The momentum that the force has given is that of the gas.
  EXPECT_NEAR(run.last().received.at(1), run.last().total.at(1), 1e-13);
}

}  // namespace force_test
