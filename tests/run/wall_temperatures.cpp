// The mean temperatures of walls without a given temperature, in records, history and results.
#include "gas_tables.hpp"

#include <apsis/config/case.hpp>
#include <apsis/run/found_walls.hpp>
#include <apsis/run/manifest.hpp>
#include <apsis/run/records.hpp>
#include <apsis/run/simulation.hpp>
#include <apsis/run/surface_table.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace wall_temperatures_test {
namespace {

using namespace apsis;
using testing::ElementsAre;

std::string gas_in(const std::string& space, const std::string& velocity = "max = 6.5\npoints = 12\n") {
  return gas_tables({.epsilon = "0.2", .velocity = velocity, .method = "md-imex-5-2", .end = "0.03"}) +
         "[initial]\nrho = \"1 + 0.2*x\"\nT = \"1 + 0.3*x*y\"\n[output]\nsurfaces = [\"all\"]\n[space]\n" +
         space;
}

const std::string plane = gas_in(R"toml(
cells = [14, 12]
domain = [[0, 1.4], [0, 1.2]]
boundary = "diffuse"
[boundary.left]
kind = "adiabatic"
velocity = [0, 0.5]
[[space.solid]]
name = "plate"
from = [1.0, 0]
to = [1.2, 0.3]
kind = "radiating"
sigma = 0.3
surroundings = 0.8
[[space.solid]]
name = "cold"
from = [0.9, 1]
to = [1, 1.2]
T = 0.9
[[space.body]]
name = "disc"
shape = "circle"
centre = [0.65, 0.62]
radius = 0.23
kind = "adiabatic"
accommodation = 0.8
)toml");

/// Returns Σ A T_w/Σ A over the rows of a surface.
double mean_of(const simulation& run, const std::string& name) {
  const auto tables = run.surfaces();
  const auto table =
      std::find_if(tables.begin(), tables.end(), [&](const surface_table& one) { return one.name == name; });
  const auto& columns = table->numbers.columns;
  const auto place = [&](const char* column) {
    return static_cast<std::size_t>(std::find(columns.begin(), columns.end(), column) - columns.begin());
  };
  double sum = 0.0, area = 0.0;
  for (const auto& row : table->numbers.rows) {
    sum += row.at(place("area")) * row.at(place("T_w"));
    area += row.at(place("area"));
  }
  return sum / area;
}

std::vector<std::string> names_of(const simulation& run) {
  std::vector<std::string> names;
  for (const found_wall& wall : found_walls(run.setup())) names.push_back(wall.name);
  return names;
}

/// Compares the records at the start and after every step with the tables of the surfaces.
void expect_means(const std::string& text, const std::vector<std::string>& names) {
  simulation run(parse_case(text, "walls.toml"));
  EXPECT_EQ(names_of(run), names);
  const auto compare = [&] {
    const auto& found = run.last().wall_temperature;
    ASSERT_EQ(found.size(), names.size());
    // Both values are sums of some tens of terms of size 1.
    for (std::size_t k = 0; k < names.size(); ++k)
      EXPECT_NEAR(found[k], mean_of(run, names[k]), 1e-14) << names[k] << run.step();
  };
  compare();
  EXPECT_EQ(run.initial_record().wall_temperature, run.last().wall_temperature);
  while (!run.finished()) {
    run.advance();
    compare();
  }
  EXPECT_GT(run.step(), 1);
  EXPECT_NE(run.initial_record().wall_temperature, run.last().wall_temperature);
}

}  // namespace

TEST(wall_temperatures, are_the_means_over_sides_boxes_and_bodies) {
  expect_means(plane, {"left", "plate", "disc"});
  // On a line the data have no y.
  std::string line = gas_in("cells = 12\nboundary = \"diffuse\"\n[boundary.right]\nkind = \"adiabatic\"\n");
  line.replace(line.find("*x*y"), 4, "*x");
  expect_means(line, {"right"});
}

TEST(wall_temperatures, about_an_axis_are_the_means_over_rings) {
  expect_means(gas_in(R"toml(
geometry = "axisymmetric"
cells = [12, 8]
domain = [[0, 1.5], [0, 1]]
boundary = "diffuse"
[boundary.top]
kind = "adiabatic"
[[space.body]]
name = "ball"
shape = "circle"
centre = [0.7, 0]
radius = 0.45
kind = "radiating"
sigma = 0.2
surroundings = 0.9
)toml",
                      "max = 5\npoints = 8\nrings = 6\nangles = 12\n"),
               {"top", "ball"});
}

TEST(wall_temperatures, are_columns_of_the_history_and_numbers_of_the_result) {
  simulation run(parse_case(plane, "walls.toml"));
  run_records records(run);
  while (!run.finished()) {
    run.advance();
    records.add_step(run.last());
  }
  const numeric_table history = records.history();
  std::vector<std::string> found;
  for (const std::string& column : history.columns)
    if (column.rfind("T_w", 0) == 0) found.push_back(column);
  EXPECT_THAT(found, ElementsAre("T_w_left", "T_w_plate", "T_w_disc"));
  const std::vector<double> last(history.rows.back().end() - 3, history.rows.back().end());
  EXPECT_EQ(last, run.last().wall_temperature);
  const auto result = manifest(run, {})["result"];
  EXPECT_EQ(result["sides"]["left"]["T_w"], last[0]);
  EXPECT_EQ(result["bodies"]["plate"]["T_w"], last[1]);
  EXPECT_EQ(result["bodies"]["disc"]["T_w"], last[2]);
  EXPECT_FALSE(result["bodies"]["cold"].contains("T_w"));
  EXPECT_EQ(result["sides"].size(), 1U);
}

TEST(wall_temperatures, of_a_wall_that_emits_nothing_are_no_numbers) {
  // A wall that reflects all molecules has no temperature.
  simulation run(parse_case(plane, "walls.toml", {"boundary.left.accommodation=0", "time.end=0.01"}));
  run.advance();
  EXPECT_TRUE(std::isnan(run.last().wall_temperature.front()));
  EXPECT_FALSE(std::isnan(run.last().wall_temperature.back()));
  EXPECT_TRUE(manifest(run, {})["result"]["sides"]["left"]["T_w"].is_null());
}

TEST(wall_temperatures, survive_a_restart) {
  const auto config = parse_case(plane, "walls.toml");
  simulation whole(config), first(config), second(config);
  while (!whole.finished()) whole.advance();
  first.advance();
  second.restore(first.save());
  EXPECT_EQ(second.last().wall_temperature, first.last().wall_temperature);
  while (!second.finished()) second.advance();
  EXPECT_EQ(second.last().wall_temperature, whole.last().wall_temperature);
}

TEST(wall_temperatures, of_given_walls_have_no_column) {
  simulation run(parse_case(gas_in("cells = [6, 5]\nboundary = \"diffuse\"\n"), "walls.toml"));
  EXPECT_TRUE(run.last().wall_temperature.empty());
  run.advance();
  EXPECT_TRUE(run.last().wall_temperature.empty());
  EXPECT_TRUE(temperature_columns(run.setup()).empty());
}

}  // namespace wall_temperatures_test
