// Steady flows past bodies, with the blocks of processes for their solution.
#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <semidiscrete/gas_past_bodies.hpp>

namespace flows_past_bodies_test {

using namespace gas_past_bodies_test;
using blocks_of_mesh = std::array<int, 3>;

struct named_flow {
  std::string name;
  choices of;
  double ux;  ///< velocity of the start and of the stream
  std::vector<blocks_of_mesh> blocks;
};

/// Returns a case of a warm body between walls.
inline choices warm(std::vector<outside_function> bodies, int cells, double epsilon) {
  return {.cells = cells,
          .bodies = std::move(bodies),
          .scheme = "upwind5",
          .boundary = "diffuse",
          .limited = false,
          .wall_temperature = 1.2,
          .epsilon = epsilon};
}

/// Returns a case of a body in a stream.
inline choices in_stream(std::vector<outside_function> bodies, int cells, double epsilon, double ux) {
  choices one = warm(std::move(bodies), cells, epsilon);
  one.boundary = "inflow";
  one.boundary_values = {{"rho", {1.0}}, {"u", {ux, 0.0}}, {"T", {1.0}}};
  one.wall_temperature = 1.0;
  return one;
}

/// A triangle with two oblique sides.
inline double triangle(const position& x) {
  return std::max({-0.4 - x[1], 0.914 * x[0] + 0.406 * x[1] - 0.2946, 0.5547 * x[1] - 0.832 * x[0] - 0.1941});
}

inline const outside_function disc = ball({0.13, -0.07, 0}, 0.45);

inline std::vector<named_flow> flows() {
  const std::vector<outside_function> discs = {ball({0.51, 0.43, 0}, 0.3), ball({-0.32, -0.2, 0}, 0.42)};
  choices specular = in_stream({disc}, 16, 0.5, 0.4);
  specular.wall = "symmetry";
  // A rotating disc drives the gas.
  choices periodic = warm({either(ball({0.07, -1.0, 0}, 0.5), ball({0.07, 1.0, 0}, 0.5))}, 14, 0.5);
  periodic.boundary = "periodic";
  periodic.wall_temperature = 1.0;
  const apsis::face_quantity::function ux = [](double, const position& x) {
    return -0.6 * (x[1] - (x[1] > 0.0 ? 1.0 : -1.0));
  };
  const apsis::face_quantity::function uy = [](double, const position& x) { return 0.6 * (x[0] - 0.07); };
  periodic.wall_velocity = {ux, uy};
  choices ball_in_space = warm({ball({0.1, -0.05, 0.03}, 0.6)}, 8, 1.0);
  ball_in_space.dimensions = 3;
  choices limited = in_stream({disc}, 16, 0.1, 1.5);
  limited.limited = true;
  return {
      {"a disc in four quarters", warm({disc}, 16, 1.0), 0.0, {{2, 1, 1}, {3, 1, 1}, {2, 2, 1}}},
      {"a rare gas", warm({disc}, 16, 100.0), 0.0, {{2, 2, 1}}},
      {"a dense gas", warm({disc}, 16, 0.02), 0.0, {{1, 2, 1}, {3, 1, 1}}},
      {"a disc inside one block", warm({ball({-0.5, 0.52, 0}, 0.3)}, 20, 0.3), 0.0, {{2, 2, 1}}},
      {"two discs", warm(discs, 18, 0.3), 0.0, {{2, 1, 1}, {1, 3, 1}, {2, 2, 1}}},
      {"a triangle", warm({triangle}, 15, 1.0), 0.0, {{2, 1, 1}, {2, 2, 1}}},
      {"a disc in a stream", in_stream({disc}, 16, 0.2, 0.4), 0.4, {{2, 1, 1}, {3, 1, 1}, {2, 2, 1}}},
      {"a specular disc in a stream", specular, 0.4, {{2, 1, 1}, {1, 3, 1}, {2, 2, 1}}},
      {"a body across a periodic face", periodic, 0.0, {{2, 1, 1}, {1, 2, 1}, {2, 2, 1}}},
      {"a limited gas", limited, 1.5, {{2, 2, 1}}},
      // A block inside the disc has no gas.
      {"blocks without gas", warm({ball({0.25, 0.25, 0}, 0.45)}, 12, 1.0), 0.0, {{4, 4, 1}}},
      {"columns of three cells", warm({disc}, 12, 1.0), 0.0, {{4, 1, 1}}},
      {"a ball", ball_in_space, 0.0, {{2, 2, 1}, {1, 1, 3}}},
  };
}

/// Runs body(flow, blocks) on the blocks of all flows, including columns and rows of single cells.
template <class Body>
void for_all_blocks(const Body& body) {
  for (const named_flow& flow : flows()) {
    std::vector<blocks_of_mesh> all = flow.blocks;
    all.push_back({flow.of.cells, 1, 1});
    all.push_back({1, flow.of.cells, 1});
    for (const blocks_of_mesh& blocks : all) {
      const testing::ScopedTrace trace(__FILE__, __LINE__,
                                       fmt::format("{}, {} x {} blocks", flow.name, blocks[0], blocks[1]));
      body(flow.of, blocks);
    }
  }
}

}  // namespace flows_past_bodies_test
