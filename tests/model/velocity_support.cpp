// The part of a Maxwellian that velocities miss agrees with the normal distribution. Cheap bounds agree with
// the sums.
#include <apsis/model/velocity_support.hpp>

#include <apsis/model/gas_model.hpp>
#include <apsis/model/model_registry.hpp>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace velocity_support_test {

namespace {

using testing::HasSubstr;

std::unique_ptr<apsis::model> gas_on(const std::string& set, int points, double max, int dimensions = 1) {
  auto parts = apsis::default_config(apsis::find_model("bgk"));
  parts.parameters["velocity_dimensions"] = dimensions;
  parts.parameters["degrees_of_freedom"] = 3;
  parts.velocity.set = {set};
  parts.velocity.points = points;
  parts.velocity.max = max;
  return apsis::find_model("bgk").make(parts);
}

apsis::fluid_state at_rest(double T) {
  apsis::fluid_state state;
  state.rho = 1.0;
  state.T = T;
  return state;
}

std::vector<double> moments_of(const apsis::fluid_state& s, int dimensions) {
  std::vector<double> omega = {s.rho};
  double square = 3.0 * s.T;
  for (int k = 0; k < dimensions; ++k) {
    omega.push_back(s.rho * s.u[k]);
    square += s.u[k] * s.u[k];
  }
  omega.push_back(0.5 * s.rho * square);
  return omega;
}

}  // namespace

TEST(velocity_support, misses_what_lies_beyond_the_ends) {
  const auto gas = gas_on("uniform", 200, 4.0);
  const auto support = apsis::support_of(*gas);
  for (const double T : {0.7, 1.0, 2.0, 5.0}) {
    const double kappa = 4.0 / std::sqrt(T), mass = std::erfc(kappa / std::sqrt(2.0)),
                 energy = mass + 2.0 * kappa * std::exp(-0.5 * kappa * kappa) / std::sqrt(2.0 * M_PI);
    const auto fit = support->fit(at_rest(T));
    EXPECT_TRUE(fit.ends);
    EXPECT_NEAR(fit.beyond, mass, 1e-12);
    // The midpoint rule has an error of Δv²/24 times the slope of c² G at its end.
    EXPECT_NEAR(fit.missed, energy, 2e-3 * energy) << T;
  }
}

TEST(velocity_support, misses_what_the_spacing_does_not_resolve) {
  // By Poisson's sum formula the energy at u = 0 misses 2 (4π²T/Δv² − 1) exp(−2π²T/Δv²). For an even number
  // of points it has the sign of a cosine.
  const auto gas = gas_on("uniform", 20, 20.0);  // Δv = 2
  const auto support = apsis::support_of(*gas);
  for (const double T : {1.5, 2.0, 2.5}) {
    const double x = 2.0 * M_PI * M_PI * T / 4.0;
    const auto fit = support->fit(at_rest(T));
    EXPECT_FALSE(fit.ends);
    EXPECT_NEAR(fit.missed, 2.0 * (2.0 * x - 1.0) * std::exp(-x), 1e-6) << T;
  }
}

TEST(velocity_support, of_several_directions_is_that_of_the_worst) {
  const auto gas = gas_on("uniform", 32, 5.0, 3);
  const auto support = apsis::support_of(*gas);
  apsis::fluid_state state = at_rest(1.0);
  state.u[1] = 2.0;
  const auto fit = support->fit(state);
  EXPECT_EQ(fit.direction, 1);
  EXPECT_NEAR(fit.beyond, 0.5 * std::erfc(3.0 / std::sqrt(2.0)), 1e-9);
}

TEST(velocity_support, belongs_to_gases) {
  for (const char* name : {"broadwell", "discrete-velocity", "relaxation"}) {
    const auto entry = apsis::try_find_model(name);
    const auto other = entry->make(apsis::default_config(*entry));
    EXPECT_FALSE(apsis::support_of(*other).has_value()) << name;
    const std::vector<double> omega(8, 1.0);
    EXPECT_EQ(apsis::why_beyond_velocities(*other, omega.data()), "");
  }
}

RC_GTEST_PROP(velocity_support, safe_margins_need_no_sums, ()) {
  const std::string set = *rc::gen::element<std::string>("uniform", "graded", "gauss-hermite");
  const int points = 2 * *rc::gen::inRange(8, 30);
  const auto gas = gas_on(set, points, set == "gauss-hermite" ? 0.0 : 8.0);
  const auto support = apsis::support_of(*gas);
  apsis::fluid_state state = at_rest(std::exp(1e-3 * *rc::gen::inRange(-4000, 1500)));
  state.u[0] = 1e-3 * *rc::gen::inRange(-4000, 4000);
  const auto margins = support->margins(moments_of(state, 1).data());
  const auto fit = support->fit(state);
  if (apsis::velocity_support::is_safe(margins))
    RC_ASSERT(fit.missed < (set == "uniform" ? 3e-7 : apsis::velocity_limits::good));
  // The room alone determines the share beyond the nearer end.
  const double nearer = 0.5 * std::erfc(std::sqrt(0.5 * margins.room));
  RC_ASSERT(margins.room == 0.0 ||
            (fit.beyond >= nearer * (1.0 - 1e-9) && fit.beyond <= 2.0 * nearer + 1e-15));
}

TEST(velocity_support, of_an_empty_or_cold_cell_is_not_judged) {
  const auto gas = gas_on("uniform", 32, 5.0);
  const auto support = apsis::support_of(*gas);
  for (const std::vector<double>& omega :
       {std::vector<double>{0.0, 0.0, 0.0}, {1.0, 1.0, 0.5}, {1.0, 2.0, 1.0}}) {
    EXPECT_TRUE(std::isinf(support->margins(omega.data()).room));
    apsis::fluid_state state;
    EXPECT_FALSE(support->fit_of_moments(omega.data(), state).has_value());
  }
}

TEST(velocity_support, at_the_end_of_the_grid_names_the_cause) {
  const auto gas = gas_on("uniform", 32, 8.0);  // last velocity 7.75
  const std::vector<double> at_end = {1.0, 7.75, 0.5 * 7.75 * 7.75}, inside = {1.0, 5.0, 12.5};
  EXPECT_THAT(apsis::why_beyond_velocities(*gas, at_end.data()),
              HasSubstr("its bulk velocity 7.75 is at the end 7.75 of the velocity grid"));
  EXPECT_EQ(apsis::why_beyond_velocities(*gas, inside.data()), "");
}

}  // namespace velocity_support_test
