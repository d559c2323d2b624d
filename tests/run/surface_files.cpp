// Files of surfaces: content, units, continued runs, and refused names.
#include "cases_in_space.hpp"
#include "support/folder.hpp"

#include <apsis/config/case_json.hpp>
#include <apsis/config/case_schema.hpp>
#include <apsis/core/text_file.hpp>
#include <apsis/output/checkpoint.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <support/bad_input.hpp>

namespace surface_files_test {

using namespace apsis;
using namespace in_several_dimensions;
using testing::ElementsAre;
using testing::HasSubstr;
namespace fs = std::filesystem;

namespace {

const std::string gas = R"toml(
[gas]
name = "argon"
pressure = "10 Pa"
temperature = "300 K"
length = "1 mm"
[model]
name = "bgk"
[initial]
rho = 1
T = "300 K"
[space]
cells = [6, 5]
domain = [["0 mm", "2 mm"], ["0 mm", "1 mm"]]
boundary = "diffuse"
reconstruction = "upwind1"
[boundary.left]
T = "330 K"
[[space.solid]]
name = "block"
from = [1, 0]
to = ["4/3", 0.4]
[velocity]
max = 7
points = 8
[time]
method = "md-imex-3-2"
end = 0.05
safety = 1
[output]
surfaces = ["left", "block"]
)toml";

std::string text_of(const std::string& path) {
  return read_text_file(path, 1'000'000, "file");
}

struct table {
  std::vector<std::string> faces;
  std::map<std::string, std::vector<double>> columns;
};

/// Reads a table with text in the first column.
table read_surface(const std::string& path) {
  std::istringstream file(text_of(path));
  table out;
  std::vector<std::string> names;
  std::string line, cell;
  std::getline(file, line);
  for (std::istringstream header(line); std::getline(header, cell, ',');) names.push_back(cell);
  EXPECT_EQ(names.front(), "face");
  while (std::getline(file, line)) {
    std::istringstream row(line);
    std::getline(row, cell, ',');
    out.faces.push_back(cell);
    for (std::size_t k = 1; std::getline(row, cell, ','); ++k)
      out.columns[names.at(k)].push_back(std::stod(cell));
  }
  return out;
}

void continue_into(const std::string& folder, const std::string& text, const std::string& checkpoint,
                   const std::vector<std::string>& overrides = {}) {
  session_options how;
  how.out = folder;
  how.restart = checkpoint;
  run_session(parse_case(text, "case.toml", overrides), how).run();
}

}  // namespace

TEST(files_of_surfaces, have_the_face_first_and_are_those_of_the_case_alone) {
  const test_folder folder;
  run_into(folder / "o", gas);
  EXPECT_FALSE(fs::exists(folder / "o/surfaces/top.csv"));
  const table left = read_surface(folder / "o/surfaces/left.csv"),
              block = read_surface(folder / "o/surfaces/block.csv");
  EXPECT_EQ(left.faces, std::vector<std::string>(5, "left"));
  // The box stands on the floor, with no gas below it.
  EXPECT_THAT(block.faces, ElementsAre("right", "right", "top", "left", "left"));
  EXPECT_GT(left.columns.at("pressure").at(2), 0.9);
  run_into(folder / "o", gas, {"output.surfaces=[\"top\"]"});
  EXPECT_TRUE(fs::exists(folder / "o/surfaces/top.csv"));
  EXPECT_FALSE(fs::exists(folder / "o/surfaces/left.csv"));
  run_into(folder / "o", gas, {"output.surfaces=[]"});
  EXPECT_FALSE(fs::exists(folder / "o/surfaces"));
}

TEST(files_of_surfaces, are_in_the_units_of_the_results_as_the_history_is) {
  const test_folder folder;
  run_into(folder / "own", gas);
  run_into(folder / "si", gas, {"output.units=SI"});
  const gas_scales scales = *parse_case(gas, "case.toml").scales;
  const table own = read_surface(folder / "own/surfaces/left.csv"),
              si = read_surface(folder / "si/surfaces/left.csv");
  const std::map<std::string, dimension> columns = {{"s", dimensions::length},
                                                    {"y", dimensions::length},
                                                    {"area", dimensions::length},
                                                    {"momentum_x", dimensions::pressure},
                                                    {"energy", dimensions::heat_flux},
                                                    {"pressure", dimensions::pressure},
                                                    {"shear_stress", dimensions::pressure},
                                                    {"heat_flux", dimensions::heat_flux},
                                                    {"rho", dimensions::density},
                                                    {"u_x", dimensions::velocity},
                                                    {"T", dimensions::temperature}};
  for (const auto& [name, dims] : columns)
    for (std::size_t k = 0; k < 5; ++k) {
      const double expected = own.columns.at(name)[k] * scales.unit(dims);
      EXPECT_NEAR(si.columns.at(name)[k], expected, 1e-14 * std::abs(expected)) << name;
    }
  // The reference pressure is 10 Pa. In the plane a force is one per length.
  EXPECT_NEAR(si.columns.at("pressure")[2], 10.0, 1.0);
  double force = 0.0;
  for (std::size_t k = 0; k < 5; ++k) force += si.columns.at("area")[k] * si.columns.at("momentum_x")[k];
  const std::string history = text_of(folder / "si/history.csv");
  const std::string header = history.substr(0, history.find('\n'));
  const std::string before = header.substr(0, header.find("flux_left_momentum_x"));
  std::istringstream last(history.substr(history.rfind('\n', history.size() - 2) + 1));
  std::string cell;
  for (auto k = std::count(before.begin(), before.end(), ',') + 1; k > 0; --k) std::getline(last, cell, ',');
  EXPECT_NEAR(std::stod(cell), -force, 1e-13 * std::abs(force));
  const auto manifest = nlohmann::json::parse(text_of(folder / "si/manifest.json"));
  EXPECT_EQ(manifest["units"]["pressure"], "Pa");
  EXPECT_EQ(manifest["units"]["heat_flux"], "W/m^2");
  EXPECT_EQ(manifest["units"]["flux_left_momentum_x"], "N/m");
  EXPECT_EQ(manifest["units"]["received_left_momentum_x"], "N s/m");
  EXPECT_EQ(manifest["units"]["flux_left_energy"], "W/m");
  EXPECT_EQ(manifest["units"]["total_energy"], "J/m");
  EXPECT_EQ(manifest["units"]["flux_left_mass"], "kg/(m s)");
  EXPECT_EQ(manifest["units"]["torque_block"], "N m/m");
}

TEST(files_of_surfaces, of_a_continued_run_are_those_of_an_uninterrupted_one) {
  const test_folder folder;
  run_into(folder / "whole", gas);
  run_into(folder / "first", gas, {"time.end=0.03"});
  continue_into(folder / "second", gas, folder / "first/checkpoint.h5");
  for (const char* file : {"surfaces/left.csv", "surfaces/block.csv"})
    EXPECT_EQ(text_of(folder / (std::string("whole/") + file)),
              text_of(folder / (std::string("second/") + file)))
        << file;
}

TEST(files_of_surfaces, of_a_continuation_without_a_step_are_those_of_the_last_step) {
  const test_folder folder;
  const std::vector<std::string> steady = {"time.end=100", "time.steady=1"};
  run_into(folder / "first", gas, steady);
  continue_into(folder / "second", gas, folder / "first/checkpoint.h5", steady);
  const std::string first = text_of(folder / "first/surfaces/left.csv"),
                    second = text_of(folder / "second/surfaces/left.csv");
  EXPECT_EQ(first, second);
  EXPECT_THAT(first, testing::Not(HasSubstr("nan")));
  // A checkpoint without surface budgets, or with those of another case, does not match this run.
  checkpoint other = read_checkpoint(folder / "first/checkpoint.h5");
  EXPECT_EQ(other.budget.size(), (2 * 5 + 5 + 6 + 5) * 4U);
  other.budget.pop_back();
  write_checkpoint(folder / "other.h5", other);
  bad_input::expect_refused({{[&] { continue_into(folder / "third", gas, folder / "other.h5", steady); },
                              {"the saved boundary budget has another size"}}});
  other.budget.clear();
  write_checkpoint(folder / "without.h5", other);
  continue_into(folder / "third", gas, folder / "without.h5", steady);
  EXPECT_THAT(text_of(folder / "third/surfaces/left.csv"), HasSubstr("nan"));
}

TEST(files_of_surfaces, of_a_run_without_a_step_have_places_and_no_values) {
  const test_folder folder;
  run_into(folder / "o", gas, {"time.end=0"});
  const table left = read_surface(folder / "o/surfaces/left.csv");
  EXPECT_NEAR(left.columns.at("y").at(4), 0.9, 1e-15);
  for (const char* name : {"mass", "energy", "pressure", "shear_stress", "heat_flux"})
    EXPECT_TRUE(std::isnan(left.columns.at(name).at(0))) << name;
  EXPECT_GT(left.columns.at("T").at(0), 1.0);  // the hot wall emits half of the gas
}

TEST(surfaces_of_a_case, are_read_back_from_its_text) {
  const case_config once = parse_case(gas, "case.toml"), twice = parse_case(to_toml(once), "again");
  EXPECT_THAT(twice.output.surfaces, ElementsAre("left", "block"));
  EXPECT_EQ(to_json(once)["output"]["surfaces"][1], "block");
  EXPECT_THAT(schema_text(), HasSubstr("surfaces (text or a list of texts"));
}

}  // namespace surface_files_test
