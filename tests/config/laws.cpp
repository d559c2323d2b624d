// Cases with conservation laws given by formulas: lists of texts and the automatic speed.
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

namespace {

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

double speed_of(const std::vector<std::string>& overrides) {
  return apsis::parse_case(good, "c.toml", overrides).model.parameters.at("speed");
}

}  // namespace

TEST(law, automatic_speed_is_the_fastest_wave_of_the_data_times_the_margin) {
  // The speed has four digits and is rounded up.
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
}

TEST(law, has_named_data_only_with_its_default_formulas) {
  const std::string text =
      "[model]\nname = \"conservation-law\"\n[space]\ncells = 20\ndomain = [0.0, 2.0]\n[time]\nmethod = "
      "\"md-imex-3-2\"\nend = 0.1\ncfl = 0.5\n";
  EXPECT_EQ(apsis::parse_case(text, "c.toml").model.initial, "smooth");
}

TEST(schema, documents_lists_and_automatic_parameters) {
  const std::string text = apsis::schema_text();
  EXPECT_THAT(text, HasSubstr("variables (list of names, default [\"h\", \"q\"])"));
  EXPECT_THAT(text, HasSubstr("flux (list of formulas in the names of 'variables'"));
  EXPECT_THAT(text, HasSubstr("speed (number, 1e-06 to 1000000, or \"auto\"; default \"auto\")"));
}

}  // namespace laws_test
