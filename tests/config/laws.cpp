// Cases with a conservation law of the user: lists of texts, the automatic speed, and messages with their
// place.
#include <apsis/config/case.hpp>
#include <apsis/config/case_schema.hpp>
#include <apsis/core/errors.hpp>
#include <apsis/model/model_registry.hpp>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace laws_test {

using testing::HasSubstr;
using testing::StartsWith;

namespace {

// Line numbers of the tests below refer to this text.
const std::string good = R"case([parameters]
g = 9.81
[model]
name = "conservation-law"
variables = ["h", "q"]
flux = ["q", "q^2/h + g*h^2/2"]
speed = "auto"
epsilon = 0
[initial]
h = "x < 1 ? 4 : 1"
q = 0
[space]
cells = 20
domain = [0.0, 2.0]
boundary = "outflow"
[time]
method = "md-imex-3-2"
end = 0.1
cfl = 0.5
)case";

std::string error_of(const std::string& text, const std::vector<std::string>& overrides = {}) {
  try {
    apsis::parse_case(text, "c.toml", overrides);
  } catch (const apsis::error& e) {
    EXPECT_EQ(e.code(), apsis::exit_code::input);
    return e.what();
  }
  return "accepted";
}

std::string with(const std::string& from, const std::string& to) {
  std::string text = good;
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return error_of(text.replace(at, from.size(), to));
}

double speed_of(const std::vector<std::string>& overrides) {
  return apsis::parse_case(good, "c.toml", overrides).model.parameters.at("speed");
}

}  // namespace

TEST(law, automatic_speed_is_the_fastest_wave_of_the_data_times_the_margin) {
  // Four digits, rounded up.
  const double fastest = std::sqrt(9.81 * 4.0);
  EXPECT_NEAR(speed_of({}), 2.0 * fastest, 1e-3 * fastest);
  EXPECT_GE(speed_of({}), 2.0 * fastest);
  EXPECT_NEAR(speed_of({"model.speed_margin=1.25"}), 1.25 * fastest, 1e-3 * fastest);
  EXPECT_NEAR(speed_of({"parameters.g=1"}), 4.0, 1e-10);
  EXPECT_NEAR(speed_of({"initial.q=x < 1 ? 8 : 0"}), 2.0 * (2.0 + fastest), 1e-3 * fastest);
  EXPECT_EQ(speed_of({"model.speed=13.5"}), 13.5);
  EXPECT_EQ(speed_of({"model.speed=27/2"}), 13.5);
  EXPECT_EQ(speed_of({"model.speed=auto"}), speed_of({}));
  EXPECT_EQ(speed_of({"model.speed=\"auto\""}), speed_of({}));
}

TEST(law, automatic_speed_depends_on_no_mesh_so_that_the_runs_of_a_study_share_it) {
  for (const char* cells : {"space.cells=7", "space.cells=80", "space.cells=5000"})
    EXPECT_EQ(speed_of({cells}), speed_of({})) << cells;
}

TEST(law, of_a_resolved_case_reads_back_with_its_lists_and_its_speed) {
  const auto c = apsis::parse_case(good, "c.toml", {"model.odd=[\"q\"]"});
  EXPECT_EQ(c.model.lists.at("variables"), (std::vector<std::string>{"h", "q"}));
  EXPECT_EQ(c.model.lists.at("flux").back(), "q^2/h + g*h^2/2");
  const std::string text = to_toml(c);
  EXPECT_THAT(text, HasSubstr("flux = [\"q\", \"q^2/h + g*h^2/2\"]\n"));
  EXPECT_THAT(text, HasSubstr("odd = [\"q\"]\n"));
  EXPECT_EQ(to_toml(apsis::parse_case(text, "again")), text);
}

TEST(law, lists_are_given_on_the_command_line) {
  const auto c = apsis::parse_case(good, "c.toml",
                                   {"model.variables=[\"a\", \"h\", \"q\"]",
                                    "model.flux=[\"a*q/h\", \"q\", \"q^2/h + h^2/2\"]", "initial.a=1"});
  EXPECT_EQ(make_model(c)->components(), 6);
  EXPECT_EQ(make_model(c)->invariants(), (std::vector<std::string>{"a", "h", "q"}));
  EXPECT_THAT(error_of(good, {"model.flux=[\"q\""}), HasSubstr("write for example [\"rho\", \"u\"]"));
  EXPECT_THAT(
      error_of(good, {"model.flux=q"}),
      StartsWith("override 'model.flux=q': 'model.flux' is the text 'q' (a list of texts is needed)"));
}

TEST(law, that_does_not_fit_is_refused_at_its_place) {
  EXPECT_EQ(error_of(good), "accepted");
  const std::string variables = "[\"h\", \"q\"]", flux = "[\"q\", \"q^2/h + g*h^2/2\"]";
  EXPECT_THAT(with("q^2/h + g*h", "q^2/H + g*h"),
              StartsWith("c.toml:6:19: expression 'q^2/H + g*h^2/2' cannot be used (unknown name 'H' at "
                         "character 5); did you mean 'h'?"));
  EXPECT_THAT(with("q^2/h + g*h", "q^2/h + x*h"), StartsWith("c.toml:6:23: "));
  EXPECT_THAT(with("q^2/h + g*h", "q^2/h +* h"), HasSubstr("unexpected operator '*'"));
  EXPECT_THAT(with(flux, "[\"q\", 3]"), StartsWith("c.toml:6:1: 'model.flux' is the integer 3"));
  EXPECT_THAT(with(flux, "\"q\""), StartsWith("c.toml:6:1: 'model.flux' is the text 'q' (a list of texts"));
  EXPECT_THAT(with(flux, "[\"q\"]"), StartsWith("c.toml:6:1: model.flux has 1 formula (each of the 2 "
                                                "variables h, q has one flux); give 2 formulas"));
  EXPECT_THAT(with(flux, "[\"q\", \"h\", \"q\"]"), StartsWith("c.toml:6:1: model.flux has 3 formulas"));
  EXPECT_THAT(with(variables, "[]"), StartsWith("c.toml:6:"));  // the fluxes have no variable
  const std::vector<std::pair<std::string, std::string>> names = {
      {"g", "a parameter of the case has this name"},
      {"x", "it is a coordinate or time"},
      {"t", "it is a coordinate or time"},
      {"pi", "formulas have a function or constant of this name"},
      {"sqrt", "formulas have a function or constant of this name"},
      {"h", "it occurs twice"},
      {"1st", "a name is a letter followed by"},
      {"where", "it is a key of other tables"},
      {"kind", "it is a key of other tables"}};
  for (const auto& [name, why] : names) {
    EXPECT_THAT(with(variables, "[\"h\", \"" + name + "\"]"),
                StartsWith("c.toml:5:1: 'model.variables' is a list of 2 ('" + name))
        << name;
    EXPECT_THAT(with(variables, "[\"h\", \"" + name + "\"]"), HasSubstr(why)) << name;
  }
  EXPECT_THAT(with("\nq = 0", "\nu = 0"), StartsWith("c.toml:11:1: unknown key 'initial.u'"));
  EXPECT_THAT(with("q = 0\n[space]", "[space]"), HasSubstr("key 'initial.q' is missing"));
  EXPECT_THAT(with("speed = \"auto\"", "odd = [\"m\"]"),
              StartsWith("c.toml:7:1: model.odd has 'm' (it is no variable of the law); "));
  EXPECT_THAT(with("boundary = \"outflow\"", "boundary = \"symmetry\""),
              HasSubstr("boundary 'symmetry' cannot be used (model.odd does not say"));
}

TEST(law, with_a_bad_speed_is_refused_at_its_place) {
  const auto speed = [](const std::string& value) { return with("speed = \"auto\"", "speed = " + value); };
  EXPECT_THAT(speed("0"), StartsWith("c.toml:7:1: 'model.speed' is the integer 0 (it must be from 1e-06"));
  EXPECT_THAT(speed("-3.5"), StartsWith("c.toml:7:1: 'model.speed' is the number -3.5 (it must be from"));
  EXPECT_THAT(speed("nan"), StartsWith("c.toml:7:1: 'model.speed' is the number nan (it must be finite)"));
  EXPECT_THAT(speed("\"fast\""),
              StartsWith("c.toml:7:1: 'model.speed' is the text 'fast' (a number or \"auto\" "
                         "is needed)"));
  EXPECT_THAT(with("speed = \"auto\"", "speed_margin = 0.9"), StartsWith("c.toml:7:1: 'model.speed_margin'"));
}

TEST(law, without_a_value_or_a_slope_at_the_data_is_refused_at_its_place) {
  EXPECT_THAT(with("q^2/h", "q^2/(h - 1)"),
              StartsWith("c.toml:9:1: the initial data have no equilibrium at x = "));
  EXPECT_THAT(with("4 : 1", "4 : log(x - 1.5)"), HasSubstr("is nan at x = "));
  // sqrt(q) is finite at 0, but its slope is not.
  EXPECT_THAT(with("q^2/h", "sqrt(q)"),
              StartsWith("c.toml:6:1: model.flux has no finite derivative at h = 4, q = 0"));
  EXPECT_THAT(with("[\"q\", \"q^2/h + g*h^2/2\"]", "[\"3\", \"4\"]"),
              StartsWith("c.toml:7:1: model.speed cannot be chosen (every eigenvalue of F' is 0"));
}

TEST(law, has_named_data_only_with_its_default_formulas) {
  const std::string text =
      "[model]\nname = \"conservation-law\"\n[space]\ncells = 20\ndomain = [0.0, 2.0]\n[time]\nmethod = "
      "\"md-imex-3-2\"\nend = 0.1\ncfl = 0.5\n";
  EXPECT_EQ(apsis::parse_case(text, "c.toml").model.initial, "smooth");
  EXPECT_EQ(error_of(text, {"model.initial=dam-break"}), "accepted");
  EXPECT_THAT(error_of(text, {"model.flux=[\"q\", \"q^2/h + h^2\"]"}),
              StartsWith("c.toml:1:1: the case has no initial data"));
  EXPECT_THAT(error_of(text, {"model.flux=[\"q\", \"q^2/h + h^2\"]", "model.initial=smooth"}),
              StartsWith("override 'model.initial=smooth': the case has no initial data"));
}

TEST(schema, documents_lists_and_automatic_parameters) {
  const std::string text = apsis::schema_text();
  EXPECT_THAT(text, HasSubstr("variables (list of names, default [\"h\", \"q\"])"));
  EXPECT_THAT(text, HasSubstr("flux (list of formulas in the names of 'variables'"));
  EXPECT_THAT(text, HasSubstr("speed (number, 1e-06 to 1000000, or \"auto\"; default \"auto\")"));
}

}  // namespace laws_test
