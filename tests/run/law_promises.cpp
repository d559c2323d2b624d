// Conservation laws of the user: what a run promises, checks and refuses.
#include "laws.hpp"

#include <apsis/core/errors.hpp>
#include <apsis/exec/parallel.hpp>

#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

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
    // Inside walls the momentum is not conserved, but known: what crosses the faces.
    for (const char* ends : {"periodic", "outflow", "symmetry"}) {
      apsis::simulation run(apsis::load_case(fmt::format("laws/{}", name),
                                             {cells(60), fmt::format("space.boundary={}", ends)}));
      EXPECT_TRUE(run.promises().conservation);
      finish(run);
      for (const double defect : run.last().conservation_defect) EXPECT_LT(defect, 1e-13) << name << ends;
    }
  }
}

TEST(law, gives_the_same_bits_on_any_number_of_threads) {
  const overrides long_mesh = {cells(700), "time.end=0.02"};
  apsis::set_threads(1);
  const auto one = finished_case("euler-sod", long_mesh).state();
  apsis::set_threads(3);
  const auto three = finished_case("euler-sod", long_mesh).state();
  apsis::set_threads(1);
  EXPECT_EQ(one, three);
}

TEST(law, with_a_speed_that_the_data_exceed_is_refused) {
  try {
    const apsis::simulation run(apsis::load_case("laws/dam-break", {"model.speed=0.95"}));
    FAIL() << "accepted";
  } catch (const apsis::input_error& e) {
    EXPECT_THAT(e.what(), testing::StartsWith(
                              "override 'model.speed=0.95': model.speed = 0.95 is too small (an eigenvalue "
                              "of F' is 1 in size at h = 1, q = 0, and the subcharacteristic condition is "
                              "|lambda| <= speed); give at least 1 [cell 0]"));
  }
  // Equality is allowed: the speed of the deep side, exactly.
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
  // The exact solution reaches 1.2572; wiggles of a percent.
  EXPECT_EQ(failure_of("dam-break", {"model.speed=1.3"}), "kept its promises");
  EXPECT_THAT(failure_of("p-system", {"model.speed=1.8"}), HasSubstr("broken promise: model.speed = 1.8"));
}

TEST(law, that_ceases_to_be_hyperbolic_ends_with_a_broken_promise) {
  // A pressure p = v − v³/3 with λ² = −p' < 0 for v < 1: the collision compresses v from 1.3 below 1.
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
  try {
    finished_run(text, {});
    FAIL() << "accepted";
  } catch (const apsis::numerical_error& e) {
    EXPECT_THAT(e.what(), HasSubstr("broken promise: model.flux is not hyperbolic at v = 0.9"));
    EXPECT_THAT(e.what(), HasSubstr("perturbations of short wavelength grow without bound"));
  }
}

TEST(law, promises_its_condition_and_no_positivity) {
  const apsis::simulation run(apsis::load_case("laws/euler-sod"));
  EXPECT_EQ(run.promises().text(), "promised at every step: conservation, subcharacteristic condition");
  EXPECT_FALSE(run.promises().positivity);
  EXPECT_THROW(apsis::simulation(apsis::load_case("laws/euler-sod", {"space.limiter=positivity"})),
               apsis::input_error);
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
