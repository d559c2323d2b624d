// Ends with a given mass flux, and walls whose temperature balances the heat that crosses them.
#include <apsis/boundary/boundary_registry.hpp>
#include <apsis/boundary/limited_flow.hpp>
#include <apsis/core/errors.hpp>
#include <apsis/model/model_registry.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <support/bad_input.hpp>

namespace given_flows_test {

namespace {

using apsis::face;
using apsis::face_quantities;
using apsis::make_boundary;

using row = std::vector<double>;

std::unique_ptr<apsis::model> gas_of(int dimensions, int degrees) {
  auto parts = apsis::default_config(apsis::find_model("bgk"));
  parts.parameters["velocity_dimensions"] = dimensions;
  parts.parameters["degrees_of_freedom"] = degrees;
  parts.velocity.max = 8.0;
  parts.velocity.points = dimensions == 1 ? 32 : 20;
  return apsis::find_model("bgk").make(parts);
}

row maxwellian(const apsis::model& gas, const row& state) {
  row f(static_cast<std::size_t>(gas.components()));
  EXPECT_EQ(gas.data_forms().front().row(state, f), "");
  return f;
}

/// Returns the sums Σ w v_n (1, ½|v − u|²) over all velocities, the fluxes of mass and heat into the gas.
std::array<double, 2> fluxes(const apsis::model& gas, const face& where, const row& f, double along = 0.0) {
  const auto& v = gas.velocities();
  const auto n = static_cast<std::size_t>(v.size());
  const auto inward = apsis::inward_speeds(where, v);
  std::array<double, 2> sums{};
  for (std::size_t j = 0; j < n; ++j) {
    double square = f.size() > n ? f[n + j] : 0.0;
    for (int k = 0; k < v.dimensions(); ++k) {
      const double c = v.speeds(k)[j] - (k == where.direction ? 0.0 : along);
      square += c * c * f[j];
    }
    sums[0] += v.weights()[j] * inward[j] * f[j];
    sums[1] += v.weights()[j] * inward[j] * 0.5 * square;
  }
  return sums;
}

/// Returns the row at the face: the outgoing components of `inside` and the incoming ones of the boundary.
row at_face(const apsis::model& gas, const apsis::boundary& side, const face& where, const row& inside) {
  const auto inward = apsis::inward_speeds(where, gas.velocities());
  row leaving = inside, values(inside.size());
  for (std::size_t k = 0; k < inside.size(); ++k)
    if (inward[k] > 0.0) leaving[k] = 0.0;
  const std::array<const double*, 3> ghosts = {inside.data(), inside.data(), inside.data()};
  side.incoming_given_outgoing(where, 0.0, {}, leaving.data(), ghosts, values.data());
  for (std::size_t k = 0; k < inside.size(); ++k)
    if (!(inward[k] > 0.0)) values[k] = inside[k];
  return values;
}

row at_face(const apsis::model& gas, const std::string& kind, const face_quantities& values,
            const face& where, const row& inside) {
  return at_face(gas, *make_boundary(kind, gas, values)->prepared(where, gas.velocities()), where, inside);
}

double distance(const row& a, const row& b) {
  double most = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) most = std::max(most, std::abs(a[k] - b[k]));
  return most;
}

/// Returns a distribution far from equilibrium, with zeros.
row noise(const apsis::model& gas, std::mt19937& random) {
  std::uniform_real_distribution<double> number(0.0, 1.0);
  row f = maxwellian(gas, row(gas.data_forms().front().variables[1].size == 2 ? row{1.0, 0.3, -0.4, 1.2}
                                                                              : row{1.0, 0.3, 1.2}));
  for (double& value : f) value *= number(random) < 0.1 ? 0.0 : 2.0 * number(random);
  return f;
}

}  // namespace

TEST(mass_flow, is_reached_to_rounding_beside_any_gas) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> flux(-0.05, 2.0), temperature(0.7, 1.5);
  for (const auto& [d, degrees] : {std::pair(1, 1), std::pair(1, 3), std::pair(2, 2), std::pair(2, 3)}) {
    const auto gas = gas_of(d, degrees);
    for (int n = 0; n < 50; ++n) {
      const face where{static_cast<int>(random() % static_cast<unsigned>(d)), random() % 2 == 0};
      const double m = flux(random), T = temperature(random);
      const row f = at_face(*gas, "mass-flow", {{"flux", {m}}, {"T", {T}}}, where, noise(*gas, random));
      // The flux is a sum of some hundred terms of size 1, each rounded to 1e-16.
      EXPECT_NEAR(fluxes(*gas, where, f)[0], m, 2e-14);
      EXPECT_GE(*std::min_element(f.begin(), f.end()), 0.0);
    }
  }
}

TEST(mass_flow, of_a_uniform_gas_does_not_disturb_it) {
  const auto gas = gas_of(1, 3);
  for (const double u : {-0.6, -0.1, 0.2, 0.7})
    for (const bool upper : {false, true}) {
      const row inside = maxwellian(*gas, {1.3, u, 0.9});
      const double m = 1.3 * (upper ? -u : u);
      const row f = at_face(*gas, "mass-flow", {{"flux", {m}}, {"T", {0.9}}}, face{0, upper}, inside);
      EXPECT_LT(distance(f, inside), 1e-12) << u << upper;
    }
}

TEST(mass_flow, that_is_not_reached_lets_nothing_enter_and_says_so) {
  const auto gas = gas_of(1, 3);
  const face where{0, true};
  const auto side = make_boundary("mass-flow", *gas, {{"flux", {-2.0}}})->prepared(where, gas->velocities());
  const auto& flow = dynamic_cast<const apsis::limited_flow&>(*side);
  const row inside = maxwellian(*gas, {1.0, 0.0, 1.0});
  EXPECT_FALSE(flow.take_shortfall());
  const row f = at_face(*gas, *side, where, inside);
  // All arriving gas at rest leaves: √(T/2π). The error of the midpoint rule is about Δv²/24 times the slope
  // of v M at 0.
  EXPECT_NEAR(fluxes(*gas, where, f)[0], -1.0 / std::sqrt(2.0 * M_PI), 5e-3);
  EXPECT_TRUE(flow.take_shortfall());
  EXPECT_FALSE(flow.take_shortfall());
  // An inlet fills a vacuum, and nothing leaves a vacuum at an outlet.
  const row nothing(inside.size(), 0.0);
  EXPECT_EQ(at_face(*gas, *side, where, nothing), nothing);
  EXPECT_NEAR(fluxes(*gas, where, at_face(*gas, "mass-flow", {{"flux", {0.3}}}, where, nothing))[0], 0.3,
              1e-15);
}

TEST(heat_balance, of_an_adiabatic_wall_is_zero_to_rounding) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> part(0.1, 1.0), speed(-0.8, 0.8);
  for (const auto& [d, degrees] : {std::pair(1, 1), std::pair(1, 3), std::pair(2, 2), std::pair(2, 3)}) {
    const auto gas = gas_of(d, degrees);
    for (int n = 0; n < 30; ++n) {
      const face where{static_cast<int>(random() % static_cast<unsigned>(d)), random() % 2 == 0};
      const double u = d == 2 ? speed(random) : 0.0;
      std::vector<apsis::face_quantity> velocity(static_cast<std::size_t>(d), 0.0);
      if (d == 2) velocity[where.direction == 0 ? 1 : 0] = u;
      const row f = at_face(*gas, "adiabatic", {{"velocity", velocity}, {"accommodation", {part(random)}}},
                            where, noise(*gas, random));
      const auto [mass, heat] = fluxes(*gas, where, f, u);
      EXPECT_NEAR(mass, 0.0, 1e-14);
      // Heat fluxes are about 1, and the discrete Maxwellian is solved up to rounding errors.
      EXPECT_NEAR(heat, 0.0, 2e-14);
      EXPECT_GE(*std::min_element(f.begin(), f.end()), 0.0);
    }
  }
}

TEST(heat_balance, of_the_slowest_and_of_the_fastest_molecules_is_found) {
  // If all molecules arrive with one speed v, T_w tends to v². With larger T_w the velocities
  // have no Maxwellian.
  const face where{0, true};
  for (const auto& [d, degrees] : {std::pair(1, 1), std::pair(2, 2), std::pair(1, 3)}) {
    const auto gas = gas_of(d, degrees);
    const auto n = static_cast<std::size_t>(gas->velocities().size());
    for (const bool slow : {true, false})
      for (const double share : {0.0, 1e-12, 1e-6, 1e-3, 0.1, 0.5}) {
        row inside(static_cast<std::size_t>(gas->components()), 0.0);
        const auto speeds = gas->velocities().speeds(0);
        const double v = slow ? 0.0 : *std::max_element(speeds.begin(), speeds.end());
        for (std::size_t j = 0; j < n; ++j) {
          bool nearest = true;
          for (int k = 0; k < d; ++k)
            nearest = nearest && std::abs(std::abs(gas->velocities().speeds(k)[j]) - v) < 0.41;
          inside[j] = nearest ? 1.0 : share * 1e-2;
        }
        const row f = at_face(*gas, "adiabatic", {}, where, inside);
        const auto [mass, heat] = fluxes(*gas, where, f);
        const double arriving = std::abs(fluxes(*gas, where, inside)[1]) + 0.5 * v * v;
        EXPECT_NEAR(mass, 0.0, 1e-13 * (1.0 + v)) << d << degrees << slow << share;
        // At this limit the heat vanishes only up to the tolerance of the balance.
        EXPECT_NEAR(heat, 0.0, 1e-10 * (1.0 + arriving) * (1.0 + v)) << d << degrees << slow << share;
        EXPECT_GE(*std::min_element(f.begin(), f.end()), 0.0);
      }
  }
}

TEST(heat_balance, of_free_molecules_has_the_recovery_temperature) {
  // Molecules at rest along the wall bring 2T, as (D + 1)/2 = 2. Those with the velocity U bring ½U² more, so
  // T_w = T + U²/4.
  const auto gas = gas_of(2, 3);
  const face where{0, false};
  const double T = 0.9, U = 0.7;
  const row inside = maxwellian(*gas, {1.0, 0.0, U, T});
  const row f = at_face(*gas, "adiabatic", {}, where, inside),
            diffuse = at_face(*gas, "diffuse", {{"T", {T + 0.25 * U * U}}}, where, inside);
  // The midpoint rule changes the sums over half of the velocities.
  EXPECT_LT(distance(f, diffuse), 1e-2 * *std::max_element(f.begin(), f.end()));
  // A gas at rest stays in equilibrium with its wall.
  const row still = maxwellian(*gas, {1.0, 0.0, 0.0, T});
  EXPECT_LT(distance(at_face(*gas, "adiabatic", {}, where, still), still), 1e-13);
}

TEST(heat_balance, of_a_radiating_wall_tends_to_its_limits_and_balances_between_them) {
  const auto gas = gas_of(1, 3);
  const face where{0, true};
  const row inside = maxwellian(*gas, {1.2, 0.1, 1.4});
  const auto radiating = [&](double sigma, double surroundings, double emissivity = 1.0) {
    return at_face(*gas, "radiating",
                   {{"sigma", {sigma}}, {"surroundings", {surroundings}}, {"emissivity", {emissivity}}},
                   where, inside);
  };
  EXPECT_EQ(radiating(0.0, 0.8), at_face(*gas, "adiabatic", {}, where, inside));
  EXPECT_EQ(radiating(3.0, 0.8, 0.0), at_face(*gas, "adiabatic", {}, where, inside));
  EXPECT_EQ(radiating(3.0, 0.8, 0.5), radiating(1.5, 0.8));
  // A wall with strong radiation has the temperature of the surroundings.
  EXPECT_LT(distance(radiating(1e10, 0.8), at_face(*gas, "diffuse", {{"T", {0.8}}}, where, inside)), 1e-9);
  // σ is such that a wall with T_w = 1.1 radiates the heat of the diffuse wall. The radiating wall then
  // equals the diffuse one.
  const row known = at_face(*gas, "diffuse", {{"T", {1.1}}}, where, inside);
  const double heat = -fluxes(*gas, where, known)[1], between = std::pow(1.1, 4) - std::pow(0.8, 4);
  const row found = radiating(heat / between, 0.8);
  EXPECT_LT(distance(found, known), 1e-12);
  EXPECT_NEAR(-fluxes(*gas, where, found)[1], heat, 2e-14);
  EXPECT_NEAR(fluxes(*gas, where, found)[0], 0.0, 1e-14);
}

TEST(heat_balance, that_no_temperature_has_is_an_error_with_its_reason) {
  const auto gas = gas_of(1, 1);
  const face where{0, true};
  row inside(static_cast<std::size_t>(gas->components()), 0.0);
  inside.back() = 1.0;
  // All molecules have the largest speed v, so the wall has T = v². No other f >= 0 gives a hotter wall.
  const row same = at_face(*gas, "adiabatic", {}, where, inside);
  EXPECT_NEAR(fluxes(*gas, where, same)[1], 0.0, 1e-8);
  // Radiation would heat the wall above this limit.
  bad_input::expect_refused(
      {{[&] { at_face(*gas, "radiating", {{"sigma", {1e6}}, {"surroundings", {100.0}}}, where, inside); },
        {"a wall 'radiating' has no temperature that balances its heat (near T = "},
        3}});
  // If no molecules arrive, none leave.
  const row nothing(inside.size(), 0.0);
  EXPECT_EQ(at_face(*gas, "adiabatic", {}, where, nothing), nothing);
  bad_input::expect_refused({{[&] {
                                at_face(*gas, "radiating",
                                        {{"sigma", {1.0}}, {"surroundings", {1.0}}, {"emissivity", {1.5}}},
                                        where, maxwellian(*gas, {1, 0, 1}));
                              },
                              {"the emissivity of a radiating wall is 1.5"}}});
}

}  // namespace given_flows_test
