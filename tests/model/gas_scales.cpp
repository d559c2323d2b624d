// Scales of a gas and definitions of the mean free path follow from first principles in SI units.
#include <apsis/model/gas_scales.hpp>

#include <apsis/model/mean_free_path.hpp>

#include <cmath>
#include <map>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

namespace gas_scales_test {

namespace {

using apsis::gas_scales, apsis::gas_species, apsis::try_find_gas;
using std::numbers::pi;

constexpr double k_B = 1.380649e-23;

double quantity(const gas_scales& scales, const std::string& name) {
  for (const auto& one : scales.quantities())
    if (one.name == name) return one.value;
  ADD_FAILURE() << name;
  return std::nan("");
}

/// Returns the density of speeds of molecules of mass m at temperature T, per unit of speed.
double speeds(double c, double m, double T) {
  const double a = m / (2.0 * k_B * T);
  return 4.0 * pi * c * c * std::pow(a / pi, 1.5) * std::exp(-a * c * c);
}

/// Returns ∫ c f(c) dc by the midpoint rule, which is spectrally accurate for this integrand.
double mean_speed(double m, double T) {
  const double largest = 12.0 * std::sqrt(k_B * T / m);
  double sum = 0.0;
  constexpr int points = 4000;
  for (int k = 0; k < points; ++k) {
    const double c = largest * (k + 0.5) / points;
    sum += c * speeds(c, m, T) * largest / points;
  }
  return sum;
}

/// Returns the maximizer of f(c) by bisection of the sign of its difference quotient.
double most_probable_speed(double m, double T) {
  double low = 0.1 * std::sqrt(k_B * T / m), high = 10.0 * std::sqrt(k_B * T / m);
  for (int k = 0; k < 60; ++k) {
    const double c = 0.5 * (low + high), h = 1e-4 * c;
    (speeds(c + h, m, T) > speeds(c - h, m, T) ? low : high) = c;
  }
  return low;
}

gas_scales argon_at(double p, double T, double L) {
  return {*try_find_gas("argon"), p, T, L};
}

TEST(gas_scales, of_argon_are_those_of_an_ideal_gas) {
  const gas_scales s = argon_at(10.0, 300.0, 1e-3);
  EXPECT_NEAR(s.density(), 66.3e-27 * 10.0 / (k_B * 300.0), 1e-18);
  EXPECT_NEAR(s.speed(), std::sqrt(k_B * 300.0 / 66.3e-27), 1e-9);
  // p = n k T. The viscosity of argon at 300 K is 22.7 µPa s (Lemmon & Jacobsen 2004). The power law through
  // the value at 273 K has an error below 1 %.
  EXPECT_NEAR(s.viscosity(), 22.7e-6, 0.01 * 22.7e-6);
  EXPECT_NEAR(s.unit(apsis::dimensions::pressure), 10.0, 1e-12);
  EXPECT_NEAR(s.unit(apsis::dimensions::time), 1e-3 / s.speed(), 1e-18);
  EXPECT_NEAR(s.unit(apsis::dimensions::mass), s.density() * 1e-9, 1e-24);
  EXPECT_NEAR(s.unit(apsis::dimensions::heat_flux), 10.0 * s.speed(), 1e-9);
  EXPECT_NEAR(s.unit(apsis::dimensions::number_density * apsis::dimensions::length), 1e6, 1e-6);
  // ε is the time μ/p in units of L/√(RT). In this time the stress of a BGK gas relaxes.
  EXPECT_NEAR(s.epsilon(), s.viscosity() / 10.0 / s.time(), 1e-12 * s.epsilon());
  EXPECT_NEAR(s.epsilon() * s.unit(apsis::dimensions::viscosity), s.viscosity(), 1e-12 * s.viscosity());
}

TEST(gas_scales, mean_free_path_of_variable_hard_spheres_is_that_of_their_diameter) {
  // Bird 1994, table A2, has diameters at 273 K with three digits, so d² has an error of up to 0.5 %.
  const std::map<std::string, double> diameters = {
      {"air", 4.19e-10},  {"argon", 4.17e-10},    {"helium", 2.33e-10}, {"krypton", 4.76e-10},
      {"neon", 2.77e-10}, {"nitrogen", 4.17e-10}, {"xenon", 5.74e-10}};
  EXPECT_EQ(diameters.size(), apsis::known_gases().size());
  for (const gas_species& gas : apsis::known_gases()) {
    const double d = diameters.at(gas.name);
    const gas_scales s(gas, 20.0, 273.0, 2e-3);
    const double path = 1.0 / (std::sqrt(2.0) * pi * d * d * 20.0 / (k_B * 273.0));
    EXPECT_NEAR(quantity(s, "knudsen_vhs"), path / 2e-3, 6e-3 * path / 2e-3) << gas.name;
  }
}

TEST(gas_scales, mean_free_path_of_hard_spheres_is_that_of_their_viscosity) {
  const double m = 5e-26, d = 3e-10, T = 400.0, p = 50.0, L = 1e-4;
  const double mu = 5.0 / 16.0 * std::sqrt(pi * m * k_B * T) / (pi * d * d);  // Chapman & Enskog
  const gas_scales s({"", m, mu, T, 0.5, 3, 2.0 / 3.0}, p, T, L);
  const double kn = k_B * T / (std::sqrt(2.0) * pi * d * d * p) / L;
  EXPECT_NEAR(quantity(s, "knudsen_hard-sphere"), kn, 1e-12 * kn);
  EXPECT_NEAR(quantity(s, "knudsen_vhs"), kn, 1e-12 * kn);  // at ω = 1/2
}

TEST(gas_scales, other_mean_free_paths_follow_from_the_distribution_of_speeds) {
  const double T = 350.0, p = 3.0, L = 5e-3;
  for (const gas_species& gas : apsis::known_gases()) {
    const gas_scales s(gas, p, T, L);
    const double mean = mean_speed(gas.mass, T), mu = s.viscosity(), rho = gas.mass * p / (k_B * T);
    // One mean free path follows from μ = ρ c̄ λ/2. The other is the mean speed over the collision frequency
    // p/μ of the BGK model.
    const double from_viscosity = 2.0 * mu / (rho * mean), from_frequency = mean / (p / mu);
    EXPECT_NEAR(quantity(s, "knudsen_viscosity"), from_viscosity / L, 1e-10 * from_viscosity / L);
    EXPECT_NEAR(quantity(s, "knudsen_mean-speed"), from_frequency / L, 1e-10 * from_frequency / L);
    // Difference quotients locate a maximum with half of the digits.
    const double v0 = most_probable_speed(gas.mass, T), k = mu * v0 / (p * L);
    EXPECT_NEAR(quantity(s, "knudsen_equivalent"), k, 1e-7 * k);
    EXPECT_NEAR(quantity(s, "rarefaction"), 1.0 / k, 1e-7 / k);
  }
}

TEST(gas_scales, eucken_gives_two_thirds_for_a_monatomic_gas) {
  EXPECT_EQ(apsis::eucken_prandtl(3), 2.0 / 3.0);  // the lower end for ES-BGK, to the last bit
  const double gamma = 1.4;
  EXPECT_NEAR(apsis::eucken_prandtl(5), 4.0 * gamma / (9.0 * gamma - 5.0), 1e-15);
}

TEST(gas_scales, units_are_written_in_the_usual_form) {
  using apsis::unit_of;
  namespace d = apsis::dimensions;
  EXPECT_EQ(unit_of(d::none), "dimensionless");
  EXPECT_EQ(unit_of(d::pressure), "Pa");
  EXPECT_EQ(unit_of(d::heat_flux), "W/m^2");
  EXPECT_EQ(unit_of(d::density), "kg/m^3");
  EXPECT_EQ(unit_of(d::mass_flux), "kg/(m^2 s)");
  EXPECT_EQ(unit_of(d::number_density), "1/m^3");
  EXPECT_EQ(unit_of(d::none / d::time), "1/s");
  EXPECT_EQ(unit_of(d::pressure * d::length), "J/m^2");
}

TEST(gas_scales, units_of_amounts_are_those_of_space_per_length_and_area) {
  using apsis::unit_of_amount, apsis::unit_of_torque;
  namespace d = apsis::dimensions;
  const std::vector<std::vector<const char*>> expected = {
      {"kg", "kg/s", "N s", "N", "J", "W", "N m"},
      {"kg/m", "kg/(m s)", "N s/m", "N/m", "J/m", "W/m", "N m/m"},
      {"kg/m^2", "kg/(m^2 s)", "N s/m^2", "Pa", "J/m^2", "W/m^2", "N m/m^2"}};
  auto per = d::none;
  for (int lacking = 0; lacking < 3; ++lacking, per = per * d::length) {
    std::vector<std::string> units;
    for (auto amount : {d::mass, d::mass * d::velocity, d::mass * d::velocity * d::velocity})
      for (const auto& dims : {amount / per, amount / d::time / per})
        units.push_back(unit_of_amount(dims, lacking));
    units.push_back(unit_of_torque(lacking));
    EXPECT_EQ(units, std::vector<std::string>(expected[static_cast<std::size_t>(lacking)].begin(),
                                              expected[static_cast<std::size_t>(lacking)].end()));
  }
}

}  // namespace

}  // namespace gas_scales_test
