// Fields of a gas. Every component of the bulk velocity has its own name.
#include <apsis/model/model_registry.hpp>

#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fluid_fields_test {

namespace {

using testing::ElementsAre;

std::unique_ptr<apsis::model> gas(int dimensions) {
  auto config = apsis::default_config(apsis::find_model("bgk"));
  config.parameters["velocity_dimensions"] = dimensions;
  config.velocity = {9.0, 24, apsis::equilibrium_choice::automatic};
  return apsis::find_model("bgk").make(config);
}

std::vector<std::string> names_of_fields(const apsis::model& m) {
  std::vector<std::string> names;
  for (const auto& field : m.default_fields()) names.push_back(field.name);
  return names;
}

/// Returns ρ (2πT)^{−d/2} exp(−|v − u|²/(2T)) at the velocities of the model.
std::vector<double> maxwellian(const apsis::model& m, double rho, const std::vector<double>& u, double T) {
  std::vector<double> f;
  for (int j = 0; j < m.components(); ++j) {
    double square = 0.0;
    for (std::size_t k = 0; k < u.size(); ++k)
      square += std::pow(m.speeds(static_cast<int>(k))[static_cast<std::size_t>(j)] - u[k], 2);
    const double height = rho * std::pow(2.0 * std::numbers::pi * T, -0.5 * static_cast<double>(u.size()));
    f.push_back(height * std::exp(-0.5 * square / T));
  }
  return f;
}

std::vector<double> fields_of(const apsis::model& m, const std::vector<double>& f) {
  std::vector<double> values(m.default_fields().size());
  m.macroscopic(f.data(), values.data());
  return values;
}

}  // namespace

TEST(fluid_fields, have_one_bulk_velocity_per_dimension) {
  EXPECT_THAT(names_of_fields(*gas(1)), ElementsAre("rho", "u", "T", "heat_flux"));
  EXPECT_THAT(names_of_fields(*gas(2)), ElementsAre("rho", "u_x", "u_y", "T", "stress_xx", "stress_xy",
                                                    "stress_yy", "heat_flux_x", "heat_flux_y"));
  EXPECT_THAT(names_of_fields(*gas(3)),
              ElementsAre("rho", "u_x", "u_y", "u_z", "T", "stress_xx", "stress_xy", "stress_xz", "stress_yy",
                          "stress_yz", "stress_zz", "heat_flux_x", "heat_flux_y", "heat_flux_z"));
  EXPECT_EQ(gas(1)->default_fields()[1].label, "bulk velocity (dimensionless)");
  EXPECT_EQ(gas(3)->default_fields()[2].label, "bulk velocity along y (dimensionless)");
  EXPECT_THAT(gas(1)->invariants(), ElementsAre("mass", "momentum", "energy"));
  EXPECT_THAT(gas(2)->invariants(), ElementsAre("mass", "momentum_x", "momentum_y", "energy"));
}

TEST(fluid_fields, of_a_sampled_maxwellian_are_its_density_velocity_and_temperature) {
  const std::vector<double> velocity = {0.3, -0.4, 0.25};
  for (const int d : {1, 2, 3}) {
    const auto m = gas(d);
    const std::vector<double> u(velocity.begin(), velocity.begin() + d);
    const auto values = fields_of(*m, maxwellian(*m, 1.25, u, 1.1));
    // With Δv = 3/4 and v_max = 9, truncation and aliasing are below 1e-12.
    EXPECT_NEAR(values[0], 1.25, 1e-11);
    for (std::size_t k = 0; k < u.size(); ++k) EXPECT_NEAR(values[1 + k], u[k], 1e-11) << d << " " << k;
    EXPECT_NEAR(values[u.size() + 1], 1.1, 1e-11);
    for (std::size_t k = u.size() + 2; k < values.size(); ++k) EXPECT_NEAR(values[k], 0.0, 1e-11) << d;
  }
}

TEST(fluid_fields, of_two_beams_have_their_stress_and_heat_flux) {
  // With f = Σ_k ρ_k M[u_k, T_k] and c_k = u_k − u, the stress is Σ ρ_k (c_k c_kᵀ + T_k I) − p I. The heat
  // flux is ½ Σ ρ_k c_k (|c_k|² + (d + 2) T_k).
  for (const int d : {1, 2, 3}) {
    const auto m = gas(d);
    const std::vector<double> rho = {0.7, 0.5}, T = {1.2, 0.8};
    const std::vector<std::vector<double>> u = {{0.3, -0.2, 0.1}, {-0.6, 0.4, 0.5}};
    std::vector<double> f(static_cast<std::size_t>(m->components()), 0.0), mean(3);
    for (std::size_t k = 0; k < 2; ++k) {
      const auto beam = maxwellian(*m, rho[k], {u[k].begin(), u[k].begin() + d}, T[k]);
      for (std::size_t j = 0; j < f.size(); ++j) f[j] += beam[j];
      for (std::size_t i = 0; i < 3; ++i) mean[i] += rho[k] * u[k][i] / 1.2;
    }
    const auto n = static_cast<std::size_t>(d);
    const auto values = fields_of(*m, f);
    const double p = 1.2 * values[n + 1];
    std::size_t at = n + 2;
    for (std::size_t a = 0; a < n && n > 1; ++a)  // a gas with a single degree of freedom has no stress
      for (std::size_t b = a; b < n; ++b) {
        double stress = a == b ? -p : 0.0;
        for (std::size_t k = 0; k < 2; ++k)
          stress += rho[k] * ((u[k][a] - mean[a]) * (u[k][b] - mean[b]) + (a == b ? T[k] : 0.0));
        EXPECT_NEAR(values[at++], stress, 1e-9) << d;
      }
    for (std::size_t a = 0; a < n; ++a) {
      double heat = 0.0;
      for (std::size_t k = 0; k < 2; ++k) {
        double square = 0.0;
        for (std::size_t i = 0; i < n; ++i) square += (u[k][i] - mean[i]) * (u[k][i] - mean[i]);
        heat += 0.5 * rho[k] * (u[k][a] - mean[a]) * (square + (d + 2) * T[k]);
      }
      EXPECT_NEAR(values[at++], heat, 1e-9) << d;  // the end v_max = 9 cuts off a share of 1e-10
    }
    EXPECT_EQ(at, values.size());
  }
}

TEST(fluid_fields, are_permuted_with_the_axes) {
  const auto m = gas(3);
  const auto f = fields_of(*m, maxwellian(*m, 0.8, {0.2, -0.5, 0.1}, 1.3));
  const auto g = fields_of(*m, maxwellian(*m, 0.8, {0.1, 0.2, -0.5}, 1.3));
  EXPECT_NEAR(f[1], g[2], 1e-14);
  EXPECT_NEAR(f[2], g[3], 1e-14);
  EXPECT_NEAR(f[3], g[1], 1e-14);
  EXPECT_NEAR(f[4], g[4], 1e-13);
}

}  // namespace fluid_fields_test
