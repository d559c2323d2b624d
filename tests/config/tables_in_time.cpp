// Values of boundaries from files with times and values: numbers, units, round trip, messages.
#include <apsis/boundary/domain.hpp>
#include <apsis/config/boundary_reader.hpp>
#include <apsis/config/case.hpp>
#include <apsis/config/case_json.hpp>
#include <apsis/config/case_schema.hpp>
#include <apsis/core/text_file.hpp>

#include <cmath>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <support/bad_input.hpp>
#include <support/folder.hpp>

namespace tables_in_time_test {

using namespace apsis;

namespace {

std::string with_gas(const std::string& boundary) {
  return R"toml([gas]
name = "argon"
pressure = "10 Pa"
temperature = "300 K"
length = "1 mm"
[model]
name = "bgk"
velocity_dimensions = 2
[initial]
rho = 1
T = 1
[space]
cells = 8
formulation = "finite-difference"
limiter = "positivity"
boundary = "diffuse"
[velocity]
max = 7
points = 16
[time]
method = "md-imex-6-3"
end = 0.1
safety = 1
)toml" + boundary;
}

class tables_in_time : public testing::Test {
 protected:
  std::string file(const std::string& name, const std::string& content) const {
    const std::string path = folder_ / name;
    write_text_file(path, content);
    return path;
  }
  void read(const std::string& content, const std::string& more = "") const {
    const std::string path = file("wall.csv", content);
    parse_case(with_gas(fmt::format("[boundary.left]\nT = {{ file = \"{}\"{} }}\n", path, more)), "c.toml");
  }

  test_folder folder_;
};

}  // namespace

TEST_F(tables_in_time, belong_to_the_case_with_all_digits) {
  std::string rows = "t,T,velocity_y\n";
  for (int k = 0; k < 500; ++k) rows += fmt::format("{},{},{}\n", k / 3000.0, 1.0 + k / 7000.0, -k / 9000.0);
  const std::string path = file("wall.csv", rows);
  const case_config config = parse_case(
      with_gas(fmt::format("[boundary.left]\nT.file = \"{0}\"\nvelocity = {{ file = \"{0}\" }}\n", path)),
      "c.toml");
  std::filesystem::remove(path);
  // The case no longer needs the file. All digits survive in TOML and JSON.
  const std::string text = to_toml(config);
  const case_config again = parse_case(text, "again.toml");
  EXPECT_EQ(to_toml(again), text);
  EXPECT_EQ(again.faces[0], config.faces[0]);
  EXPECT_EQ(to_json(config)["boundary"]["left"]["T"], config.faces[0].values.at("T").front());
  EXPECT_EQ(config.faces[0].values.at("velocity").front(), "0");
  const auto sides = make_boundaries(again, make_model(again));
  EXPECT_EQ(sides[0][0]->wall_velocity(5 / 3000.0, {})[1], -5 / 9000.0);
  EXPECT_EQ(sides[0][0]->wall_velocity(-1.0, {})[1], 0.0);
  EXPECT_EQ(sides[0][0]->wall_velocity(9.0, {})[1], -499 / 9000.0);
}

TEST_F(tables_in_time, have_units_and_columns_of_any_name) {
  const std::string path = file("wall.csv", "t [us], Tw [degC], v [m/s]\n0, 26.85, 0\n10, 326.85, 30\n");
  const case_config config =
      parse_case(with_gas(fmt::format("[boundary.left]\nT = {{ file = \"{0}\", column = \"Tw\" }}\n"
                                      "velocity = {{ file = \"{0}\", column = [0, \"v\"] }}\n",
                                      path)),
                 "c.toml");
  const gas_scales& scales = *config.scales;
  const double t = 10e-6 / scales.unit(dimensions::time), v = 30.0 / scales.unit(dimensions::velocity);
  const auto sides = make_boundaries(config, make_model(config));
  EXPECT_NEAR(sides[0][0]->wall_velocity(t, {})[1], v, 1e-14 * v);
  EXPECT_NEAR(sides[0][0]->wall_velocity(0.5 * t, {})[1], 0.5 * v, 1e-14 * v);
  // The values are 300 K and 600 K in units of 300 K.
  EXPECT_THAT(config.faces[0].values.at("T").front(), testing::StartsWith("table(t, 0, 1, "));
  EXPECT_TRUE(config.faces[0].values.at("T").front().ends_with(", 2)"))
      << config.faces[0].values.at("T").front();
}

TEST_F(tables_in_time, that_cannot_be_read_are_refused_with_their_line_and_column) {
  const std::string head = "c.toml:25:7: 'boundary.left.T.file' = ";
  const std::vector<std::pair<std::string, std::string>> wrong = {
      {"t,T\n0,1\n1,abc\n", "wall.csv:3: 'abc' in column 'T' is not a finite number; change it"},
      {"t,T\n0,1\n0,2\n", "wall.csv:3: t does not increase in column 't' (0 after 0); sort the rows"},
      {"t,T\n0,1\n1\n", "wall.csv:3: 1 entries (the first line names 2 columns); give 2"},
      {"t,U\n0,1\n", "it has no column 'T' (the first line names others); did you mean 't'? valid: U, t"},
      {"time,T\n0,1\n",
       "it has no column 't' (the first line names others); did you mean 'T'? valid: T, time"},
      {"t,T [Pa]\n0,1\n", "column 'T' has the unit of Pa (that of K is needed); change it"},
      {"t,T [K\n0,1\n",
       "'T [K' is no head of a column (a name, or a name and a unit in brackets, is needed); "
       "write for example \"p [Pa]\""}};
  for (const auto& [content, says] : wrong)
    bad_input::expect_refused(
        {{[&, &text = content] { read(text); }, {head, "wall.csv\" cannot be used: ", says}}});
  bad_input::expect_refused({
      {[&] { read("t,T\n0,1\n", ", column = \"U\""); }, {"it has no column 'U'"}},
      {[&] { read("t,T\n0,1\n", ", column = true"); }, {"it must be the name of a column"}},
      {[&] { read("t,T\n0,1\n", ", colunm = \"T\""); },
       {"unknown key 'boundary.left.T.colunm' (boundary 'diffuse' has no such variable)"}},
  });
  bad_input::expect_refused(
      {{[&] { parse_case(with_gas("[boundary.left]\nT.file = \"nowhere.csv\"\n"), "c.toml"); },
        {"'boundary.left.T.file' = \"nowhere.csv\" cannot be used: "}}});
  const std::string path = file("wall.csv", "t,T\n0,1\n1,2\n");
  bad_input::expect_refused({{[&] {
                                parse_case(with_gas("[boundary.left]\nT = 2\n"), "c.toml",
                                           {fmt::format("boundary.left.T.file=\"{}\"", path)});
                              },
                              {"conflicts with 'boundary.left.T' (both give the value)"}}});
}

}  // namespace tables_in_time_test
