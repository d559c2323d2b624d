// Open ends of a gas: far field, reservoir with a given pressure, given distribution.
#include <apsis/boundary/boundary_registry.hpp>
#include <apsis/core/errors.hpp>
#include <apsis/model/model_registry.hpp>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>
#include <support/bad_input.hpp>

namespace ends_test {

namespace {

using apsis::face;
using apsis::face_quantities;
using apsis::make_boundary;
using apsis::position;

constexpr double heat_ratio = 5.0 / 3.0;

std::unique_ptr<apsis::model> monatomic_gas(int dimensions = 1) {
  auto parts = apsis::default_config(apsis::find_model("bgk"));
  parts.parameters["velocity_dimensions"] = dimensions;
  parts.parameters["degrees_of_freedom"] = 3;
  parts.velocity.max = 9.0;
  parts.velocity.points = 36;
  return apsis::find_model("bgk").make(parts);
}

/// Returns the Maxwellian of (ρ, u, T).
std::vector<double> maxwellian(const apsis::model& gas, const std::vector<double>& state) {
  std::vector<double> row(static_cast<std::size_t>(gas.components()));
  const std::string problem = gas.data_forms().front().row(state, row);
  EXPECT_EQ(problem, "");
  return row;
}

double moment(const apsis::model& gas, const std::vector<double>& row, std::size_t k) {
  std::vector<double> all(gas.invariants().size());
  gas.invariant_densities(row.data(), all.data());
  return all[k];
}

/// Returns the row at the face beside a uniform gas: the incoming components of the boundary, and the
/// outgoing ones of the gas.
std::vector<double> entering(const apsis::model& gas, const std::string& kind, const face_quantities& values,
                             const std::vector<double>& inside, bool upper) {
  const face where{0, upper};
  const auto boundary = make_boundary(kind, gas, values);
  const auto own = boundary->prepared(where, gas.velocities());
  const std::vector<double> ghost = maxwellian(gas, inside);
  const std::array<const double*, 3> ghosts = {ghost.data(), ghost.data(), ghost.data()};
  std::vector<double> row(ghost.size());
  (own ? own : boundary)->incoming_given_outgoing(where, 0.0, {}, ghost.data(), ghosts, row.data());
  return row;
}

}  // namespace

RC_GTEST_PROP(far_field, does_not_disturb_a_uniform_gas, ()) {
  const auto gas = monatomic_gas();
  const double rho = *rc::gen::inRange(1, 40) / 10.0, u = *rc::gen::inRange(-20, 21) / 10.0,
               T = *rc::gen::inRange(6, 20) / 10.0;
  const std::vector<double> f = maxwellian(*gas, {rho, u, T});
  const auto row = entering(*gas, "far-field", {{"rho", {rho}}, {"u", {u}}, {"T", {T}}}, {rho, u, T},
                            *rc::gen::arbitrary<bool>());
  for (std::size_t k = 0; k < row.size(); ++k) RC_ASSERT(std::abs(row[k] - f[k]) <= 1e-11 * rho);
}

TEST(far_field, takes_the_invariants_of_the_euler_equations_from_where_they_come) {
  const auto gas = monatomic_gas();
  const std::vector<double> far = {1.0, 0.2, 1.0}, inside = {1.3, 0.5, 1.2};
  // At the right face the invariant u + 3a leaves and u − 3a enters (γ = 5/3). Gas that leaves
  // keeps its entropy.
  const double leaving = 0.5 + 3.0 * std::sqrt(heat_ratio * 1.2),
               entering_invariant = 0.2 - 3.0 * std::sqrt(heat_ratio);
  const double u = 0.5 * (leaving + entering_invariant), a = (leaving - entering_invariant) / 6.0,
               T = a * a / heat_ratio;
  ASSERT_GT(u, 0.0);
  const double rho = 1.3 * std::pow(T / 1.2, 1.5);
  const auto row = entering(*gas, "far-field", {{"rho", {1.0}}, {"u", {0.2}}, {"T", {1.0}}}, inside, true);
  EXPECT_NEAR(moment(*gas, row, 0), rho, 1e-12);
  EXPECT_NEAR(moment(*gas, row, 1), rho * u, 1e-12);
  EXPECT_NEAR(moment(*gas, row, 2), 0.5 * rho * (u * u + 3.0 * T), 1e-12);
  // The mirrored data at the left face give the mirrored flow.
  const auto mirrored =
      entering(*gas, "far-field", {{"rho", {1.0}}, {"u", {-0.2}}, {"T", {1.0}}}, {1.3, -0.5, 1.2}, false);
  EXPECT_NEAR(moment(*gas, mirrored, 1), -rho * u, 1e-12);
}

TEST(far_field, faster_than_sound_is_the_state_upstream) {
  const auto gas = monatomic_gas();
  const face_quantities still = {{"rho", {1.0}}, {"u", {0.0}}, {"T", {1.0}}},
                        stream = {{"rho", {0.7}}, {"u", {-2.0}}, {"T", {1.0}}};
  EXPECT_NEAR(moment(*gas, entering(*gas, "far-field", still, {2.0, 1.5, 1.0}, true), 0), 2.0, 1e-12);
  EXPECT_NEAR(moment(*gas, entering(*gas, "far-field", stream, {2.0, 0.0, 1.0}, true), 0), 0.7, 1e-12);
}

TEST(far_field, lets_gas_into_a_vacuum_and_out_of_it_at_the_speed_of_sound) {
  const auto gas = monatomic_gas();
  // The gas at rest expands to u = a. The invariant is 3√γ = a + 3a, so a = 3/4 √γ, T = 9/16 and ρ = T^(3/2).
  const double a = 0.75 * std::sqrt(heat_ratio), T = 0.5625, rho = 0.75 * T;
  const face_quantities still = {{"rho", {1.0}}, {"T", {1.0}}},
                        thin = {{"rho", {1e-6}}, {"u", {2.0}}, {"T", {1.0}}};
  const std::vector<double> receding = {1e-6, -2.0, 1.0};
  const auto in = entering(*gas, "far-field", still, receding, true);
  EXPECT_NEAR(moment(*gas, in, 0), rho, 1e-12);
  EXPECT_NEAR(moment(*gas, in, 1), -rho * a, 1e-12);
  EXPECT_NEAR(moment(*gas, in, 2), 0.5 * rho * (a * a + 3.0 * T), 1e-12);
  const auto out = entering(*gas, "far-field", thin, {1.0, 0.0, 1.0}, true);
  EXPECT_NEAR(moment(*gas, out, 0), rho, 1e-12);
  EXPECT_NEAR(moment(*gas, out, 1), rho * a, 1e-12);
}

TEST(pressure_end, has_its_pressure_and_lets_the_outgoing_characteristic_pass) {
  const auto gas = monatomic_gas(2);
  const double rho = 1.2, u = 0.3, uy = 0.4, T = 1.1, p_inside = rho * T, a = std::sqrt(heat_ratio * T),
               p = 1.25;
  // The invariant u + p/(ρa) leaves. The density changes at constant entropy, to first order.
  const double u_out = u + (p_inside - p) / (rho * a), rho_out = rho + (p - p_inside) / (a * a);
  const auto row = entering(*gas, "pressure", {{"p", {p}}}, {rho, u, uy, T}, true);
  EXPECT_NEAR(moment(*gas, row, 0), rho_out, 1e-12);
  EXPECT_NEAR(moment(*gas, row, 1), rho_out * u_out, 1e-12);
  EXPECT_NEAR(moment(*gas, row, 2), rho_out * uy, 1e-12);
  const double energy = 0.5 * rho_out * (u_out * u_out + uy * uy) + 1.5 * p;
  EXPECT_NEAR(moment(*gas, row, 3), energy, 1e-12);
}

TEST(pressure_end, gives_gas_of_its_temperature_at_most_at_the_speed_of_sound) {
  const auto gas = monatomic_gas(2);
  const auto row = entering(*gas, "pressure", {{"p", {1.5}}, {"T", {0.9}}}, {1.0, 0.0, 0.4, 1.0}, false);
  const double a = std::sqrt(heat_ratio), u = 0.5 / a;  // (p − p_i)/(ρ_i a_i), to the right
  EXPECT_NEAR(moment(*gas, row, 0), 1.5 / 0.9, 1e-12);
  EXPECT_NEAR(moment(*gas, row, 1), 1.5 / 0.9 * u, 1e-12);
  EXPECT_NEAR(moment(*gas, row, 2), 0.0, 1e-12);  // not the 0.4 of the gas inside
  const auto fast = entering(*gas, "pressure", {{"p", {50.0}}, {"T", {0.9}}}, {1.0, 0.0, 0.0, 1.0}, false);
  EXPECT_NEAR(moment(*gas, fast, 1) / moment(*gas, fast, 0), std::sqrt(heat_ratio * 0.9), 1e-12);
  // Gas that leaves faster than sound does not depend on the reservoir.
  const auto leaves = entering(*gas, "pressure", {{"p", {50.0}}}, {1.0, 1.6, 0.0, 1.0}, true);
  EXPECT_NEAR(moment(*gas, leaves, 0), 1.0, 1e-12);
}

TEST(gas_ends, fill_a_vacuum) {
  const auto gas = monatomic_gas();
  const face where{0, false};
  const std::vector<double> nothing(static_cast<std::size_t>(gas->components()));
  const std::array<const double*, 1> ghosts = {nothing.data()};
  std::vector<double> row(nothing.size());
  make_boundary("far-field", *gas, {{"rho", {0.5}}, {"T", {1.0}}})
      ->incoming_given_outgoing(where, 0.0, {}, nothing.data(), ghosts, row.data());
  EXPECT_NEAR(moment(*gas, row, 0), 0.5, 1e-12);
  make_boundary("pressure", *gas, {{"p", {2.0}}})
      ->incoming_given_outgoing(where, 0.0, {}, nothing.data(), ghosts, row.data());
  EXPECT_NEAR(moment(*gas, row, 0), 2.0, 1e-12);
  EXPECT_NEAR(moment(*gas, row, 1), 2.0 * std::sqrt(heat_ratio), 1e-12);
}

TEST(gas_ends, values_without_a_gas_are_refused) {
  const auto gas = monatomic_gas();
  const auto evaluate = [&](const std::string& kind, const face_quantities& values) {
    entering(*gas, kind, values, {1.0, 0.0, 1.0}, true);
  };
  bad_input::expect_refused({
      {[&] { evaluate("pressure", {{"p", {-1.0}}}); },
       {"no Maxwellian has the state outside of a boundary 'pressure' (density 0"},
       3},
      {[&] { evaluate("far-field", {{"rho", {1.0}}, {"u", {0.0}}, {"T", {0.0}}}); },
       {"outside of a boundary 'far-field' (density 1, normal velocity 0, temperature 0)"},
       3},
      {[&] { evaluate("far-field", {{"rho", {1.0}}, {"u", {-30.0}}, {"T", {1.0}}}); },
       {"use more velocity.points or a larger velocity.max"},
       3},
  });
  const auto broadwell = apsis::try_find_model("broadwell");
  const auto other = broadwell->make(apsis::default_config(*broadwell));
  for (const char* kind : {"pressure", "far-field"})
    bad_input::expect_refused({
        {[&] { make_boundary(kind, *other); },
         {std::string("boundary '") + kind + "' cannot be used (the model has no Maxwellians)"}},
    });
}

TEST(given_end, is_its_function_of_the_velocity) {
  const auto gas = monatomic_gas(2);
  const apsis::face_quantity::velocity_function g = [](double t, const position&, const position& v) {
    return (1.0 + t) * std::exp(-v[0] * v[0] - 0.5 * std::pow(v[1] - 0.3, 2));
  };
  const face where{0, true};
  const auto boundary =
      make_boundary("given", *gas, {{"g", {g}}, {"h", {0.25}}})->prepared(where, gas->velocities());
  std::vector<double> row(static_cast<std::size_t>(gas->components()), -1.0);
  boundary->incoming(where, 0.5, {}, row.data(), row.data());
  const auto enters = apsis::entering_components(where, gas->velocities());
  const auto n = static_cast<std::size_t>(gas->velocities().size());
  for (std::size_t j = 0; j < n; ++j) {
    const position v = {gas->velocities().speeds(0)[j], gas->velocities().speeds(1)[j], 0.0};
    EXPECT_EQ(row[j], enters[j] != 0.0 ? g(0.5, {}, v) : -1.0);
    EXPECT_EQ(row[n + j], enters[j] != 0.0 ? 0.25 : -1.0);
  }
  const auto negative =
      make_boundary("given", *gas, {{"g", {-0.1}}, {"h", {0.25}}})->prepared(where, gas->velocities());
  bad_input::expect_refused({
      {[&] { negative->incoming(where, 0.5, {}, row.data(), row.data()); },
       {"the distribution at a boundary 'given' is -0.1 at t = 0.5, v_x = "}},
      {[&] { make_boundary("given", *gas, {{"g", {1.0}}}); }, {"boundary 'given' has no value of 'h'"}},
  });
}

}  // namespace ends_test
