// Conservation laws of the user: promises, checks and refusals of a run.
#include "laws.hpp"

#include <apsis/core/errors.hpp>
#include <apsis/model/scalar_flux.hpp>

#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <support/bad_input.hpp>

namespace law_promises_test {

using testing::HasSubstr;

namespace {

std::string failure_of(const std::string& name, const overrides& changes) {
  try {
    finished_case(name, changes);
  } catch (const apsis::numerical_error& e) {
    return e.what();
  }
  return "kept its promises";
}

}  // namespace

TEST(law, conserves_every_variable_to_rounding) {
  for (const char* name : {"dam-break", "p-system", "euler-sod"}) {
    // Inside walls the momentum is not conserved. The flux through the faces determines its change.
    for (const char* ends : {"periodic", "outflow", "symmetry"}) {
      apsis::simulation run(apsis::load_case(fmt::format("laws/{}", name),
                                             {cells(60), fmt::format("space.boundary={}", ends)}));
      EXPECT_TRUE(run.promises().conservation);
      finish(run);
      for (const double defect : run.last().conservation_defect) EXPECT_LT(defect, 1e-13) << name << ends;
    }
  }
}

TEST(law, may_have_the_speed_of_its_fastest_wave) {
  // The speed equals that of the deep side.
  EXPECT_NO_THROW(apsis::simulation(apsis::load_case("laws/dam-break", {"model.speed=1"})));
}

TEST(law, with_waves_that_become_too_fast_ends_with_a_broken_promise) {
  const std::string message = failure_of("dam-break", {"model.speed=1.1"});
  EXPECT_THAT(message,
              HasSubstr("broken promise: model.speed = 1.1 is too small (an eigenvalue of F' is 1."));
  EXPECT_THAT(message,
              HasSubstr("and the subcharacteristic condition is |lambda| <= speed); give at least 1."));
  EXPECT_THAT(message, HasSubstr("[step "));
  EXPECT_THAT(message, HasSubstr("cell 9"));  // behind the bore, which starts at cell 100
  // The exact solution reaches 1.2572, and the numerical one exceeds it by a percent.
  EXPECT_EQ(failure_of("dam-break", {"model.speed=1.3"}), "kept its promises");
  EXPECT_THAT(failure_of("p-system", {"model.speed=1.8"}), HasSubstr("broken promise: model.speed = 1.8"));
}

TEST(law, that_ceases_to_be_hyperbolic_ends_with_a_broken_promise) {
  // The pressure p = v − v³/3 has λ² = −p' < 0 for v < 1. The collision compresses v from 1.3 to below 1.
  const char* const text = R"case([model]
name = "conservation-law"
variables = ["v", "w"]
flux = ["-w", "v - v^3/3"]
speed = 3
epsilon = 0
[initial]
v = 1.3
w = "x < 0 ? 0.3 : -0.3"
[space]
cells = 100
domain = [-1.0, 1.0]
boundary = "outflow"
reconstruction = "upwind1"
[time]
method = "md-imex-3-2"
end = 0.5
cfl = 0.5
)case";
  EXPECT_NO_THROW(finished_run(text, {"initial.w=0"}));
  bad_input::expect_refused({{[&] { finished_run(text, {}); },
                              {"broken promise: model.flux is not hyperbolic at v = 0.9",
                               "perturbations of short wavelength grow without bound: the solution left "
                               "the states for which the law is valid); use more cells"},
                              3}});
}

namespace {

/// Returns a strong rarefaction of the Euler equations. The gas recedes from x = 0 so fast that hardly any
/// remains, and high order reconstructs a negative pressure.
std::string strong_rarefaction(const std::string& reconstruction) {
  return fmt::format(R"case([model]
name = "conservation-law"
variables = ["rho", "m", "E"]
flux = ["m", "m^2/rho + 0.4*(E - m^2/(2*rho))", "m/rho*(E + 0.4*(E - m^2/(2*rho)))"]
positive = ["rho", "0.4*(E - m^2/(2*rho))"]
epsilon = 0
[initial]
rho = 1
m = "x < 0 ? -4 : 4"
E = "1 + 8"
[space]
cells = 100
domain = [-0.5, 0.5]
boundary = "outflow"
formulation = "finite-difference"
reconstruction = "{}"
[time]
method = "md-imex-6-3"
end = 0.05
cfl = 0.5
)case",
                     reconstruction);
}

}  // namespace

TEST(law, names_the_quantity_that_became_negative) {
  bad_input::expect_refused({{[&] { finished_run(strong_rarefaction("weno5-z"), {}); },
                              {"broken promise: 0.4*(E - m^2/(2*rho)) is -",
                               "(model.positive requires it to be > 0); use more cells", "cell 4"},
                              3}});
  const auto run = finished_run(strong_rarefaction("upwind1"), {});
  EXPECT_THAT(run.promises().text(), HasSubstr("subcharacteristic condition and model.positive"));
}

TEST(law, with_data_that_are_not_positive_is_refused) {
  bad_input::expect_refused({{[&] { finished_run(strong_rarefaction("upwind1"), {"initial.E=7"}); },
                              {"0.4*(E - m^2/(2*rho)) is -0.4 at rho = 1, m = -4, E = 7 (model.positive "
                               "requires it to be > 0); change the data [cell 0]"}}});
}

TEST(law, promises_its_condition_and_no_positivity) {
  const apsis::simulation run(apsis::load_case("laws/euler-sod"));
  EXPECT_EQ(run.promises().text(),
            "promised at every step: conservation, subcharacteristic condition and model.positive");
  EXPECT_FALSE(run.promises().positivity);
  EXPECT_THROW(apsis::simulation(apsis::load_case("laws/euler-sod", {"space.limiter=positivity"})),
               apsis::input_error);
}

TEST(law, of_one_variable_runs_through_values_that_underflow) {
  // Gaussian tails end in subnormal numbers. WENO leaves such values beside sharp jumps.
  for (const char* data : {"exp(-1000*x^2)", "x < 0 ? 1 : 0", "x < 0 ? 1e-310 : 1", "x < 0 ? 1 : 1e-200"})
    for (const char* flux : {"u^2/2", "u*u/(u*u + 0.5*(1 - u)^2)", "(u + 1)^2/2", "u^3"})
      for (const char* form : {"finite-volume", "finite-difference"}) {
        const auto run = finished_run(fmt::format(R"case([model]
name = "conservation-law"
variables = ["u"]
flux = ["{}"]
epsilon = 0
[initial]
u = "{}"
[space]
cells = 50
domain = [-1.0, 1.0]
boundary = "outflow"
formulation = "{}"
[time]
method = "md-imex-6-3"
end = 0.2
cfl = 0.5
)case",
                                                  flux, data, form),
                                      {});
        EXPECT_TRUE(run.finished()) << flux << data;
      }
}

TEST(law, chooses_the_speed_of_the_states_between_a_jump) {
  // Buckley–Leverett has F' = 0 on both sides of the jump and max F' = 2.29 between them. The speed
  // is twice that.
  const auto run = finished_run(R"case([model]
name = "conservation-law"
variables = ["u"]
flux = ["u^2/(u^2 + 0.5*(1 - u)^2)"]
epsilon = 0
[initial]
u = "x < 0 ? 1 : 0"
[space]
cells = 50
domain = [-1.0, 1.0]
boundary = "outflow"
[time]
method = "md-imex-6-3"
end = 0.2
cfl = 0.5
)case",
                                {});
  const apsis::scalar_flux same("buckley-leverett", 0.0, 0.5);
  EXPECT_NEAR(run.config().model.parameters.at("speed"), 2.0 * same.fastest(0.0, 1.0).speed, 1e-3);
}

TEST(law, reports_its_largest_characteristic_speed_as_a_field) {
  const auto fields = finished_case("dam-break", {"time.end=0.2", cells(50)}).fields();
  ASSERT_EQ(fields.names, (std::vector<std::string>{"h", "q", "wave_speed"}));
  for (std::size_t i = 0; i < fields.x.size(); ++i) {
    const double h = fields.values[0][i], u = fields.values[1][i] / h;
    EXPECT_NEAR(fields.values[2][i], std::abs(u) + std::sqrt(h), 1e-9);
  }
}

}  // namespace law_promises_test
