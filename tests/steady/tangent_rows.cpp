// Derivatives of equilibria, and deviations due to a gradient under collisions, agree with kinetic theory.
#include <apsis/steady/tangent_rows.hpp>

#include "gas_problem.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace tangent_rows_test {
namespace {

// Differences of rows have half of the digits.
constexpr double accuracy = 3e-6;
constexpr double T = 1.1, rho = 0.8;

/// A gas at rest with three velocity dimensions, and its tangent rows.
struct gas_at_rest {
  std::shared_ptr<const apsis::relaxation_model> equation;
  std::vector<double> omega = {rho, 0.0, 0.0, 0.0, 1.5 * rho* T};
  apsis::tangent_rows tangents;

  explicit gas_at_rest(const std::string& model)
      : equation(make_gas(model, 1, {6.5, 16}, 3)), tangents(*equation) {
    EXPECT_TRUE(tangents.move_to(omega.data()));
  }
  std::vector<double> deviation(int direction) {
    std::vector<double> matrix(25);
    const apsis::row_map moved{.factors = equation->speeds(direction)};
    tangents.moments_of_deviation(moved, moved, matrix.data());
    return matrix;
  }
};

}  // namespace

TEST(tangent_rows, have_the_moments_that_were_changed) {
  for (const char* model : {"bgk", "shakhov", "es-bgk"}) {
    gas_at_rest gas(model);
    const std::vector<double> ones(static_cast<std::size_t>(gas.equation->components()), 1.0);
    std::vector<double> matrix(25);
    gas.tangents.moments_of({.factors = ones}, matrix.data());
    for (int i = 0; i < 5; ++i)
      for (int j = 0; j < 5; ++j)
        EXPECT_NEAR(matrix[static_cast<std::size_t>(5 * i + j)], i == j ? 1.0 : 0.0, accuracy)
            << model << i << j;
  }
}

TEST(tangent_rows, carry_the_fluxes_of_the_euler_equations) {
  gas_at_rest gas("bgk");
  std::vector<double> matrix(25);
  gas.tangents.moments_of({.factors = gas.equation->speeds(0)}, matrix.data());
  // At rest the flux of mass is the momentum. That of momentum is p, 2/3 of the energy. That of energy is 5/2
  // T times the momentum.
  EXPECT_NEAR(matrix[1], 1.0, accuracy);
  EXPECT_NEAR(matrix[5 + 4], 2.0 / 3.0, accuracy);
  EXPECT_NEAR(matrix[20 + 1], 2.5 * T, accuracy);
  for (const int k : {0, 2, 3, 4}) EXPECT_NEAR(matrix[static_cast<std::size_t>(k)], 0.0, accuracy);
}

TEST(tangent_rows, have_the_viscosity_of_the_model) {
  // The stress relaxes with the rate C in BGK and Shakhov, and with C/Pr in the ellipsoidal model.
  for (const auto& [model, of_stress] : {std::pair{"bgk", 1.0}, {"shakhov", 1.0}, {"es-bgk", 2.0 / 3.0}}) {
    gas_at_rest gas(model);
    EXPECT_NEAR(gas.deviation(0)[10 + 2], of_stress * T, accuracy) << model;
    EXPECT_NEAR(gas.deviation(1)[5 + 1], of_stress * T, accuracy) << model;
  }
}

TEST(tangent_rows, have_the_conductivity_of_the_model) {
  // At constant pressure dρ = −ρ dT/T and dE = 0. The flux of energy is 5/2 ρT dT/Pr, in units of the rate of
  // relaxation of the stress.
  for (const auto& [model, of_heat] : {std::pair{"bgk", 1.0}, {"shakhov", 1.5}, {"es-bgk", 1.0}}) {
    gas_at_rest gas(model);
    for (int direction = 0; direction < 3; ++direction)
      EXPECT_NEAR(gas.deviation(direction)[20] * (-rho / T), 2.5 * rho * T * of_heat, 2e-5)
          << model << direction;
  }
}

TEST(tangent_rows, have_the_pressure_and_viscosity_of_a_rotation) {
  auto velocities = apsis::velocity_config{6.5, 16};
  velocities.rings = 24;
  velocities.angles = 16;
  const auto equation = make_gas("bgk", 1, velocities, 3);  // v_r, v_theta, v_x
  apsis::tangent_rows tangents(*equation);
  const std::vector<double> omega = {rho, 0.0, 0.0, 0.0, 1.5 * rho * T};
  ASSERT_TRUE(tangents.move_to(omega.data()));
  const double r = 0.3, tolerance = 2e-3;  // of differences over 16 angles
  const apsis::ring_turn turn(equation->polar(), true);
  const apsis::row_map turned{.turn = &turn, .radius = r}, moved{.factors = equation->speeds(0)};
  std::vector<double> matrix(25);
  tangents.moments_of(turned, matrix.data());
  // The rotation changes the radial momentum by ∫ v_θ² f dv/r = p/r, and no mass or energy.
  EXPECT_NEAR(matrix[5 + 4], 2.0 / 3.0 / r, tolerance / r);
  for (int j = 0; j < 5; ++j) {
    EXPECT_NEAR(matrix[static_cast<std::size_t>(j)], 0.0, accuracy) << j;
    EXPECT_NEAR(matrix[static_cast<std::size_t>(20 + j)], 0.0, accuracy) << j;
  }
  // A swirl u_θ causes the deviation ∂_ω(v_⊥ sin ω v_θ) E u_θ/(rT) = 2 v_r v_θ E u_θ/(rT), with the moment
  // 2 ρT u_θ/r of v_r v_θ, and −2 ρT u_θ/r² of a further rotation.
  tangents.moments_of_deviation(turned, moved, matrix.data());
  EXPECT_NEAR(matrix[10 + 2], 2.0 * T / r, tolerance * 2.0 * T / r);
  tangents.moments_of_deviation(turned, turned, matrix.data());
  EXPECT_NEAR(matrix[10 + 2], -2.0 * T / (r * r), tolerance * 2.0 * T / (r * r));
  // A gradient ∂_r u_θ causes v_r v_θ E/T.
  tangents.moments_of_deviation(moved, turned, matrix.data());
  EXPECT_NEAR(matrix[10 + 2], -T / r, tolerance * T / r);
}

TEST(tangent_rows, refuse_moments_without_equilibrium) {
  gas_at_rest gas("bgk");
  const std::vector<double> cold = {1.0, 0.0, 0.0, 0.0, -0.1};
  EXPECT_FALSE(gas.tangents.move_to(cold.data()));
}

}  // namespace tangent_rows_test
