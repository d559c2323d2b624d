// The table [output.reference]: values with units and formulas, round trips through documents, and bad input.
#include <apsis/config/case.hpp>
#include <apsis/config/case_json.hpp>
#include <apsis/config/case_schema.hpp>
#include <apsis/core/errors.hpp>

#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <support/bad_input.hpp>

namespace reference_values_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// Returns a case of 19 lines, in the plane or in space, with a body and then this table.
std::string with(const std::string& table, bool in_space = false, const std::string& before = "") {
  const std::string cells = in_space ? "[8, 8, 8]" : "[8, 8]",
                    domain = in_space ? "[[-2, 2], [-2, 2], [-2, 2]]" : "[[-2, 2], [-2, 2]]";
  return before + "[model]\nname = \"bgk\"\n" + (before.empty() ? "epsilon = 0.1\n" : "") +
         "[initial]\nrho = 1\nT = 1\n[space]\ncells = " + cells + "\ndomain = " + domain +
         "\nboundary = \"outflow\"\n[[space.body]]\nshape = " + (in_space ? "\"sphere\"" : "\"circle\"") +
         "\ncentre = " + (in_space ? "[0, 0, 0]" : "[0, 0]") +
         "\nradius = 1\n[velocity]\nmax = 5\npoints = 6\n[time]\nmethod = \"md-imex-3-2\"\nend = 1\nsafety = "
         "1\n" +
         table;
}

const std::string in_plane =
    "[output.reference]\ndensity = 1.2\nvelocity = [1.5, -0.5]\ntemperature = 0.9\nlength = 2\n";
const std::string in_space =
    "[output.reference]\ndensity = 1\nvelocity = [2, 0, 0]\ntemperature = 1\n"
    "length = 2\narea = 3.1\nup = [1, 0, 1]\ncentre = [0, 0.5, 0]\n";

apsis::reference_values read(const std::string& text, const std::vector<std::string>& overrides = {}) {
  return apsis::parse_case(text, "flow.toml", overrides).output.reference.value();
}

}  // namespace

TEST(reference_values, are_read_and_written_so_that_they_read_back) {
  for (const std::string& text : {with(in_plane), with(in_space, true)}) {
    const auto config = apsis::parse_case(text, "flow.toml");
    const auto again = apsis::parse_case(apsis::to_toml(config), "again.toml");
    EXPECT_EQ(config.output.reference, again.output.reference);
    EXPECT_EQ(apsis::to_json(config)["output"]["reference"], apsis::to_json(again)["output"]["reference"]);
  }
  EXPECT_FALSE(apsis::parse_case(with(""), "flow.toml").output.reference.has_value());
  const auto json = apsis::to_json(apsis::parse_case(with(in_plane), "flow.toml"))["output"]["reference"];
  EXPECT_EQ(json.dump(),
            R"({"density":1.2,"velocity":[1.5,-0.5],"temperature":0.9,"length":2.0,"centre":[0.0,0.0]})");
  EXPECT_THAT(apsis::schema_text(), HasSubstr("[output.reference]"));
}

TEST(reference_values, give_pressure_size_and_directions) {
  const auto flat = read(with(in_plane)), deep = read(with(in_space, true));
  EXPECT_NEAR(flat.speed(), 1.5811388300841898, 1e-15);
  EXPECT_NEAR(flat.dynamic_pressure(), 0.6 * 2.5, 1e-15);
  EXPECT_EQ(flat.size(), 2.0);
  EXPECT_THAT(flat.centre, ElementsAre(0.0, 0.0));
  EXPECT_THAT(flat.lift_direction(), ElementsAre(testing::DoubleNear(0.31622776601683794, 1e-15),
                                                 testing::DoubleNear(0.9486832980505138, 1e-15)));
  EXPECT_EQ(deep.size(), 3.1);
  EXPECT_THAT(deep.lift_direction(), ElementsAre(0.0, 0.0, 1.0));
  std::string without = in_space;
  without.erase(without.find("up ="), 15);
  EXPECT_TRUE(read(with(without, true)).lift_direction().empty());
}

TEST(reference_values, take_formulas_and_overrides) {
  const std::string text =
      with("[output.reference]\ndensity = 1\nvelocity = [\"M*sqrt(5/3)\", 0]\ntemperature = 1\nlength = 1\n",
           false, "[parameters]\nM = 2\n");
  const std::string whole =
      text.substr(0, text.find("[initial]")) + "epsilon = 0.1\n" + text.substr(text.find("[initial]"));
  EXPECT_NEAR(read(whole).velocity[0], 2.581988897471611, 1e-15);
  EXPECT_NEAR(read(whole, {"parameters.M=4"}).velocity[0], 5.163977794943222, 1e-15);
  EXPECT_EQ(read(whole, {"output.reference.length=2/4"}).length, 0.5);
  EXPECT_THAT(read(whole, {"output.reference.centre=[1, 2]"}).centre, ElementsAre(1.0, 2.0));
}

TEST(reference_values, have_units_of_a_gas) {
  const std::string gas =
      "[gas]\nname = \"argon\"\npressure = \"10 Pa\"\ntemperature = \"300 K\"\nlength = \"1 mm\"\n";
  const std::string table =
      "[output.reference]\ndensity = 1\nvelocity = [\"500 m/s\", 0]\ntemperature = \"330 K\"\nlength = "
      "\"3 mm\"\ncentre = [\"1 mm\", \"0 mm\"]\n";
  const auto found = read(with(table, false, gas));
  // v0 = √(RT) with R = 8.314462618/M J/(kg K). Published values of M for argon differ in the fourth digit.
  EXPECT_NEAR(found.velocity[0], 500.0 / std::sqrt(8.314462618 / 0.03995 * 300.0), 1e-3);
  EXPECT_NEAR(found.temperature, 1.1, 1e-14);
  EXPECT_NEAR(found.length, 3.0, 1e-14);
  EXPECT_NEAR(found.centre[0], 1.0, 1e-14);
  bad_input::expect_refused({{[&] { read(with(table, false, gas), {"output.reference.length=3 K"}); },
                              {"override 'output.reference.length=3 K': ", "its unit is that of K"}}});
}

}  // namespace reference_values_test
