#pragma once

#include "gas_tables.hpp"

#include <apsis/run/body_loads.hpp>
#include <apsis/run/surface_table.hpp>

#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

/// Streams past a body and a solid box in the plane and in space, and the tables of their walls.
namespace streams_past_bodies {

using namespace apsis;

/// A stream in the plane with few velocities.
inline const std::string open_stream = gas_tables({}) + R"toml(
[initial]
rho = 1.1
u = [1.2, 0.4]
T = 1
[space]
cells = [16, 16]
domain = [[-2, 2], [-2, 2]]
boundary = "inflow"
[boundary.left]
rho = 1.1
u = [1.2, 0.4]
T = 1
[boundary.right]
kind = "outflow"
[boundary.top]
kind = "diffuse"
T = 1.2
[boundary.bottom]
kind = "symmetry"
)toml";

inline const std::string disc = R"toml(
[[space.body]]
name = "disc"
shape = "circle"
centre = [-0.4, 0.1]
radius = 0.8
T = 1.3
velocity = ["-0.5*(y - 0.1)", "0.5*(x + 0.4)"]
)toml";

inline const std::string box = R"toml(
[[space.solid]]
name = "box"
from = [1, 0.5]
to = [1.5, 1]
)toml";

inline const std::string loads_of_stream = R"toml(
[output]
surfaces = "all"
[output.reference]
density = 1.1
velocity = [1.2, 0.4]
temperature = 1
length = 1.6
centre = [-0.4, 0.1]
)toml";

/// A stream past a rotating disc, beside a box.
inline const std::string flat = open_stream + disc + box + loads_of_stream;

/// The same flow in space.
inline const std::string deep =
    gas_tables({.degrees = "", .velocity = "max = 5\npoints = 10\n", .end = "0.02"}) + R"toml(
[initial]
rho = 1
u = [1.2, 0, 0]
T = 1
[space]
cells = [8, 7, 7]
domain = [[-2, 2], [-1.5, 2], [-1.5, 2]]
boundary = "outflow"
[[space.body]]
name = "ball"
shape = "sphere"
centre = [-0.2, 0.3, 0.2]
radius = 1
[[space.solid]]
name = "box"
from = [1, 0.5, 0]
to = [1.5, 1, 0.5]
[output]
surfaces = "all"
[output.reference]
density = 1
velocity = [1.2, 0, 0]
temperature = 1
length = 2
area = 3.14
up = [0, 0, 1]
centre = [-0.2, 0.3, 0.2]
)toml";

/// Returns the run of one of the two texts, computed once.
inline const simulation& run_of(const std::string& text) {
  static const simulation in_plane = finished(flat), in_space = finished(deep);
  return text == flat ? in_plane : in_space;
}

/// Returns the columns of a table by name.
using columns = std::map<std::string, std::vector<double>>;

inline columns columns_of(const surface_table& table) {
  columns all;
  for (const auto& row : table.numbers.rows)
    for (std::size_t k = 0; k < row.size(); ++k) all[table.numbers.columns[k]].push_back(row[k]);
  return all;
}

inline surface_table table_of(const simulation& run, const std::string& name) {
  for (auto& one : run.surfaces())
    if (one.name == name) return one;
  ADD_FAILURE() << "no surface " << name;
  return {};
}

inline double sum(const columns& of, const std::function<double(const columns&, std::size_t)>& term) {
  double total = 0.0;
  for (std::size_t k = 0; k < of.at("area").size(); ++k) total += of.at("area")[k] * term(of, k);
  return total;
}

inline std::map<std::string, double> values_of(const body_load& body, const reference_values& stream) {
  std::map<std::string, double> all;
  for (const load_value& one : loads_in_stream(body, stream)) all[one.name] = one.value;
  return all;
}

}  // namespace streams_past_bodies
