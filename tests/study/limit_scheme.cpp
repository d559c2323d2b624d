// The limit scheme agrees with equations written out by hand.
#include <apsis/study/limit_scheme.hpp>

#include "limit_cases.hpp"

#include <apsis/core/errors.hpp>
#include <apsis/run/setup.hpp>
#include <apsis/study/limit_distance.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace limit_scheme_test {

using namespace apsis;

namespace {

case_config ode_case(const std::string& method) {
  return small_case("ode", method, "");
}

/// Returns u1(1) of the limit scheme of the ODE model from u1(0) = 2.
double limit_of_ode(const std::string& method, int steps) {
  limit_scheme scheme(ode_case(method));
  scheme.start(std::array{2.0, 0.0});
  for (int n = 0; n < steps; ++n) scheme.step(1.0 / steps);
  return scheme.moments().at(0);
}

/// Returns a gas at rest with four states.
case_config jumps(const std::vector<std::string>& overrides) {
  return parse_case(
      "[model]\nname = \"bgk\"\ndegrees_of_freedom = 5\nepsilon = 0\n"
      "[initial]\nrho = \"x < 0.5 ? (y < 0.5 ? 1 : 0.2) : (y < 0.5 ? 0.5 : 0.01)\"\nT = 1\n"
      "[space]\nboundary = \"outflow\"\nlimiter = \"positivity\"\n[velocity]\nmax = 6\npoints = 8\n"
      "[time]\nmethod = \"md-imex-3-2\"\ndt = 0.0005\nend = 0.002\n",
      "jumps.toml", overrides);
}

std::string refusal(const case_config& config) {
  try {
    limit_scheme scheme(config);
  } catch (const input_error& refused) {
    return refused.what();
  }
  return "accepted";
}

double largest(const std::vector<double>& a, const std::vector<double>& b) {
  double difference = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) difference = std::max(difference, std::abs(a[k] - b[k]));
  return difference;
}

}  // namespace

TEST(limit_scheme, of_the_second_order_method_is_heuns_method_on_the_limit_equation) {
  double u = 2.0;  // u' = sin u
  const double dt = 0.1;
  for (int n = 0; n < 10; ++n) {
    const double predicted = u + dt * std::sin(u);
    u = 0.5 * u + 0.5 * (predicted + dt * std::sin(predicted));
  }
  // The tolerance covers the rounding of ten steps.
  EXPECT_NEAR(limit_of_ode("md-imex-3-2", 10), u, 1e-14);
}

TEST(limit_scheme, has_the_order_of_the_method_on_the_limit_equation) {
  const double exact = 2.0 * std::atan(std::tan(1.0) * std::numbers::e);  // u' = sin u, u(0) = 2, t = 1
  for (const auto& name : preserving_methods()) {
    const double coarse = std::abs(limit_of_ode(name, 20) - exact);
    const double fine = std::abs(limit_of_ode(name, 40) - exact);
    // The next term of the error expansion is 1/40 of the leading one times a constant of order one.
    EXPECT_NEAR(std::log2(coarse / fine), find_certificate(name).order, 0.15) << name;
  }
}

TEST(limit_scheme, takes_data_off_equilibrium_to_their_equilibrium) {
  limit_scheme scheme(ode_case("md-imex-6-3"));
  scheme.start(std::array{2.0, 5.0});
  scheme.step(0.1);
  const double u1 = scheme.moments().at(0);
  EXPECT_EQ(scheme.equilibrium(), (std::vector<double>{u1, std::sin(u1)}));
}

TEST(limit_scheme, conserves_what_the_kinetic_scheme_conserves) {
  for (const auto& model : relaxation_model_names()) {
    for (const auto& formulation : formulation_names(model)) {
      if (formulation.empty()) continue;
      const case_config config = small_case(model, "md-imex-6-3", formulation);
      const run_setup setup(config);
      const field u = setup.initial_state();
      limit_scheme scheme(config);
      scheme.start(values(u));
      const auto before = scheme.moments();
      scheme.step(0.005);
      const auto after = scheme.moments();
      const std::size_t moments = before.size() / static_cast<std::size_t>(u.cells());
      for (std::size_t k = 0; k < moments; ++k) {
        double defect = 0.0, size = 0.0;
        for (std::size_t i = k; i < before.size(); i += moments) {
          defect += after[i] - before[i];
          size += std::abs(before[i]);
        }
        // The moments of 16 cells are accurate to a few units of the last digit.
        EXPECT_LE(std::abs(defect), 1e-14 * (1.0 + size)) << model << " " << formulation << " moment " << k;
      }
    }
  }
}

// The distribution of ω inside cells depends on the explicit part of each stage. A finite-volume scheme
// evolves equal averages of ω differently if they belong to different kinetic states. Point values depend on
// ω alone.
TEST(limit_scheme, remembers_the_kinetic_state_with_cell_averages_only) {
  for (const std::string formulation : {"finite-volume", "finite-difference"}) {
    const case_config config = small_case("broadwell", "md-imex-6-3", formulation);
    const run_setup setup(config);
    const auto data = values(setup.initial_state());
    limit_scheme from_data(config), from_equilibrium(config);
    from_data.start(data);
    from_equilibrium.start(from_data.equilibrium_of(data));
    EXPECT_LT(largest(from_data.moments(), from_equilibrium.moments()), 1e-14);
    from_data.step(0.05);
    from_equilibrium.step(0.05);
    const double difference = largest(from_data.moments(), from_equilibrium.moments());
    // The difference is the fifth-order error of the quartics on 16 cells, times Δt/Δx.
    if (formulation == "finite-volume") {
      EXPECT_GT(difference, 1e-6);
      EXPECT_LT(difference, 1e-2);
    } else {
      EXPECT_LT(difference, 1e-14);
    }
  }
}

// The data have jumps at which the limiter acts, and gas leaves at the ends.
TEST(limit_scheme, is_that_of_the_kinetic_scheme_in_the_plane_and_in_space) {
  for (const char* space : {"space.cells=[9,7]", "space.cells=[6,5,7]"}) {
    const auto table = limit_distance(jumps({space}), {0.0});
    EXPECT_EQ(table.steps, 4);
    EXPECT_LT(table.rows[0].moments_end, 1e-14) << space;  // relative: roundings of four steps
    EXPECT_LT(table.rows[0].state_end, 1e-14) << space;
  }
}

TEST(limit_scheme, refuses_walls_and_solid_boxes) {
  EXPECT_THAT(refusal(jumps({"space.cells=[9,7]", "boundary.top.kind=diffuse"})),
              testing::HasSubstr("no limit scheme (rows beyond the face 'top' are not rows of cells)"));
  EXPECT_THAT(
      refusal(jumps({"space.cells=[10,10]", "space.solid.1.from=[0,0]", "space.solid.1.to=[0.5,0.5]"})),
      testing::HasSubstr("no limit scheme (it has solid boxes)"));
}

TEST(limit_scheme, refuses_methods_and_models_without_one_and_states_of_another_size) {
  EXPECT_THROW(limit_scheme(ode_case("ssprk-2-2")), input_error);
  EXPECT_THROW(limit_scheme(load_case("paper/decay", {"time.method=imdrk-2-3"})), input_error);
  limit_scheme scheme(ode_case("md-imex-3-2"));
  EXPECT_THROW(scheme.start(std::array{1.0, 2.0, 3.0}), input_error);
}

}  // namespace limit_scheme_test
