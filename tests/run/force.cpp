// Runs with a force: exact solutions for the momentum, order in time, balances.
#include <apsis/config/case.hpp>
#include <apsis/core/errors.hpp>
#include <apsis/run/body_loads.hpp>
#include <apsis/run/setup.hpp>
#include <apsis/run/simulation.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace force_test {

namespace {

using apsis::simulation;

/// A uniform periodic gas. All its molecules have the same acceleration.
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
  // For any ε the velocity is ∫ a cos 2t = (a/2) sin 2t. The tolerance covers the error of order 3 at Δt =
  // 0.01 and the mass beyond the grid.
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
  // The solution is f(t, v) = M(v − ∫a). The error has order 5 in Δv.
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

TEST(accelerated_gas, near_the_end_of_the_velocities_reports_what_the_force_does_not_give) {
  // The stream has u = 2.2 in [−5, 5]. f at the last velocities is a hundredth of its maximum.
  const std::vector<std::string> fast = {"initial.u=2.2",   "velocity.max=5",       "velocity.points=40",
                                         "model.epsilon=1", "force.acceleration=1", "time.end=0.2",
                                         "time.dt=0.01"};
  testing::internal::CaptureStderr();
  simulation run(apsis::parse_case(accelerated_gas, "force.toml", fast));
  double momentum = 0.0, energy = 0.0, share = 0.0;
  const auto before = run.initial_record().total;
  while (!run.finished()) {
    const auto& at = run.advance();
    ASSERT_EQ(at.lost.size(), 2U);
    momentum += at.dt * at.lost[0];
    energy += at.dt * at.lost[1];
    share = std::max(share, std::abs(at.lost[0]));
  }
  const std::string warnings = testing::internal::GetCapturedStderr();
  // As ρ = 1 and a = 1, the momentum would grow by 0.2.
  EXPECT_NEAR(run.last().total[1] - before[1] + momentum, 0.2, 1e-12);
  EXPECT_GT(momentum, 1e-4);
  EXPECT_GT(energy, momentum);  // lost at velocities above 1
  EXPECT_NEAR(run.summary().force_lost_momentum, share, 1e-12);
  // A loss below one percent gives no warning (velocity_range has a case with one).
  EXPECT_LT(run.summary().force_lost_energy, 0.01);
  EXPECT_EQ(warnings.find("the force gives the gas less "), std::string::npos) << warnings;
  EXPECT_LT(run_of({}).summary().force_lost_momentum, 1e-9);
}

TEST(accelerated_gas, has_balances_to_rounding) {
  const simulation run = run_of({"space.limiter=positivity"});
  EXPECT_EQ(run.setup().open_faces(), std::vector<std::string>{"force"});
  EXPECT_LE(run.summary().conservation_defect, 1e-13);
  EXPECT_EQ(run.summary().negative_values, 0);
  // The momentum that the force has given is that of the gas.
  EXPECT_NEAR(run.last().received.at(1), run.last().total.at(1), 1e-13);
}

TEST(force_past_a_body, is_the_weight_of_the_gas_that_the_body_displaces) {
  // The gas is at rest with ρ = exp(−g y), g = 0.5, past a disc of radius 1/2.
  simulation run(apsis::parse_case(R"toml(
[model]
name = "bgk"
degrees_of_freedom = 3
epsilon = 0.1
[initial]
rho = "exp(-0.5*y)"
T = 1
[force]
acceleration = [0, -0.5]
[space]
cells = [20, 20]
domain = [[-1, 1], [-1, 1]]
boundary = "diffuse"
limiter = "positivity"
[[space.body]]
name = "disc"
shape = "circle"
centre = [0.13, -0.08]
radius = 0.5
[velocity]
max = 7
points = 16
[time]
method = "md-imex-5-2"
safety = 1
end = 0.3
)toml",
                                   "buoyancy.toml"));
  const double mass = run.initial_record().total.front();
  while (!run.finished()) run.advance();
  EXPECT_NEAR(run.last().total.front(), mass, 1e-12 * mass);
  EXPECT_LE(run.summary().conservation_defect, 1e-12);
  EXPECT_TRUE(run.promises().positivity);
  EXPECT_EQ(run.summary().negative_values, 0);
  // The weight ∫ g exp(−g y) over the disc is π r² g exp(−g y₀) (1 + (g r)²/8 + …).
  const double weight = std::numbers::pi * 0.125 * std::exp(0.04) * (1.0 + 0.25 * 0.25 / 8.0);
  const apsis::body_load disc = apsis::body_loads(run.setup(), run.last()).front();
  // With ten cells per diameter the error is 0.7 %.
  EXPECT_NEAR(disc.force[1], weight, 0.01 * weight);
  EXPECT_NEAR(disc.force[0], 0.0, 0.01 * weight);
  EXPECT_NEAR(disc.heat, 0.0, 0.01 * weight);
}

}  // namespace force_test
