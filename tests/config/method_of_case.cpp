// time.method = "auto", the default. The choice follows from the case alone, and the case records its reason.
#include <apsis/config/method_of_case.hpp>

#include <apsis/config/case_explanation.hpp>
#include <apsis/config/case_schema.hpp>
#include <apsis/core/errors.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace method_of_case_test {

using testing::HasSubstr;
using testing::StartsWith;

namespace {

apsis::case_config gas(const std::vector<std::string>& overrides, const std::string& epsilon = "1e-3") {
  return apsis::parse_case("[model]\nname = \"bgk\"\nepsilon = \"" + epsilon +
                               "\"\n[initial]\nrho = 2\nT = 1.0\n[space]\ncells = 40\ndomain = [0.0, 2.0]\n"
                               "[velocity]\nmax = 10.0\npoints = 50\n[time]\nend = 0.5\n",
                           "c.toml", overrides);
}

apsis::explained_value value_of(const apsis::case_config& c, const std::string& key) {
  for (const auto& one : apsis::explain(c))
    if (one.key == key) return one;
  ADD_FAILURE() << key << " is missing";
  return {};
}

}  // namespace

TEST(automatic_method, is_the_default_and_follows_bounds_and_tolerance) {
  const auto method = [](std::vector<std::string> overrides) { return gas(overrides).time.method; };
  EXPECT_EQ(method({"time.cfl=0.5"}), "md-imex-8-3-mixed");
  EXPECT_EQ(method({"time.cfl=0.5", "time.method=auto"}), "md-imex-8-3-mixed");
  EXPECT_EQ(method({"time.cfl=0.5", "time.tolerance=1e-3"}), "extrapolated-euler-3");
  EXPECT_EQ(method({"time.cfl=0.5", "time.tolerance=1e-6"}), "extrapolated-euler-4");
  // The program chooses a method with an SSP coefficient if the limiter is on, with first-order upwind, or if
  // an SSP coefficient sets the step.
  for (const char* bound : {"space.limiter=positivity", "space.reconstruction=upwind1", "time.safety=1"})
    EXPECT_EQ(method({bound == std::string("time.safety=1") ? "title=x" : "time.cfl=0.5", bound,
                      "time.tolerance=1e-3"}),
              "md-imex-10-3-mixed")
        << bound;
  EXPECT_EQ(method({"time.cfl=0.5", "time.method=md-imex-3-2"}), "md-imex-3-2");
}

TEST(automatic_method, of_a_system_follows_the_steps_relative_to_the_relaxation) {
  const auto method = [](const std::string& epsilon, const std::string& more) {
    return apsis::parse_case(
               "[model]\nname = \"ode\"\nepsilon = " + epsilon + "\n[time]\nend = 1.0\ndt = 0.01\n" + more,
               "c.toml")
        .time.method;
  };
  // The rate is C = 1 + u₁² = 5 at the start.
  EXPECT_EQ(method("0.11", ""), "dop853");
  EXPECT_EQ(method("0.09", ""), "extrapolated-euler-8");
  EXPECT_EQ(method("1.0", "startup = \"graded\"\n"), "extrapolated-euler-8");
  EXPECT_EQ(method("0", ""), "extrapolated-euler-8");
  EXPECT_EQ(method("1.0", "tolerance = 1e-4\n"), "extrapolated-euler-4");
}

TEST(automatic_method, measures_the_ratio_over_the_domain) {
  // The step is Δt = 0.5·0.05/10, and C = 1.
  const auto request = apsis::request_of(gas({"time.cfl=0.5"}, "1e-3 + x"));
  ASSERT_TRUE(request.lowest_ratio && request.highest_ratio);
  EXPECT_NEAR(*request.lowest_ratio, 1.25e-3, 2e-5);
  EXPECT_NEAR(*request.highest_ratio, 2.5e-3 / (1e-3 + 1.0 / 64.0), 1e-3);
  EXPECT_THAT(gas({"time.cfl=0.5"}, "1e-3 + x").time.method_reason,
              HasSubstr("C dt/epsilon = 0.0013 to 0.15"));
  EXPECT_EQ(apsis::request_of(gas({"time.cfl=0.5"}, "max(x - 1, 0)")).highest_ratio,
            std::numeric_limits<double>::infinity());
}

TEST(automatic_method, exists_for_every_built_in_case) {
  for (const auto& name : apsis::case_names()) {
    const auto c = apsis::load_case(name, {"time.method=auto"});
    EXPECT_NE(c.time.method, "auto") << name;
    EXPECT_NE(c.time.method_reason, "") << name;
  }
}

TEST(automatic_method, is_written_as_the_method_it_is) {
  const auto c = gas({"time.cfl=0.5"});
  EXPECT_THAT(apsis::to_toml(c), HasSubstr("method = \"md-imex-8-3-mixed\""));
  const auto again = apsis::parse_case(apsis::to_toml(c), "again.toml");
  EXPECT_EQ(again.time.method, c.time.method);
  EXPECT_EQ(again.time.method_reason, "");
}

TEST(explanation, marks_what_is_given_what_is_a_default_and_what_is_derived) {
  const auto c = gas({"time.cfl=0.5", "space.limiter=none"});
  using origin = apsis::value_origin;
  EXPECT_EQ(value_of(c, "space.cells").origin, origin::given);
  EXPECT_EQ(value_of(c, "space.cells").value, "40");
  // A value in the case counts as given, also if it equals the default.
  EXPECT_EQ(value_of(c, "space.limiter").origin, origin::given);
  EXPECT_EQ(value_of(c, "space.reconstruction").origin, origin::default_value);
  EXPECT_EQ(value_of(c, "time.cfl").origin, origin::given);
  EXPECT_EQ(value_of(c, "time.method").origin, origin::derived);
  EXPECT_THAT(value_of(c, "time.method").reason, StartsWith("\"auto\": equal steps on a mesh"));
  EXPECT_EQ(value_of(c, "model.velocity_dimensions").origin, origin::derived);  // follows from space.cells
  EXPECT_EQ(value_of(c, "initial.rho").origin, origin::given);
  const std::string text = apsis::explanation_text(c);
  EXPECT_THAT(text, HasSubstr("space.reconstruction = \"weno5-z\""));
  EXPECT_EQ(text.find("time.dt"), std::string::npos);  // the case does not set it
}

TEST(explanation, of_a_gas_derives_epsilon_from_its_table) {
  const auto c = apsis::load_case("gas/fourier");
  EXPECT_EQ(value_of(c, "model.epsilon").origin,
            c.given.contains("model.epsilon") ? apsis::value_origin::given : apsis::value_origin::derived);
  const auto plane = apsis::load_case("gas/cavity");
  if (!plane.given.contains("space.formulation")) {
    EXPECT_EQ(value_of(plane, "space.formulation").origin, apsis::value_origin::derived);
  }
}

TEST(explanation, names_every_key_once) {
  for (const auto& name : apsis::case_names()) {
    std::vector<std::string> keys;
    for (const auto& one : apsis::explain(apsis::load_case(name))) keys.push_back(one.key);
    auto sorted = keys;
    std::sort(sorted.begin(), sorted.end());
    EXPECT_EQ(std::adjacent_find(sorted.begin(), sorted.end()), sorted.end()) << name;
  }
}

}  // namespace method_of_case_test
