#pragma once

#include "body/examples.hpp"

#include <apsis/body/triangle_surface.hpp>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

/// Surfaces of solids, and STL files with them.
namespace body_triangles {

using apsis::position;
using apsis::space_triangle;
using triangle_list = std::vector<space_triangle>;

/// Returns the surface of a box, with two triangles for each face.
inline triangle_list cuboid(const position& low, const position& high) {
  triangle_list triangles;
  for (std::size_t k = 0; k < 3; ++k)
    for (const bool upper : {false, true}) {
      const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
      std::array<position, 4> corners = {low, low, low, low};
      for (position& corner : corners) corner[k] = upper ? high[k] : low[k];
      corners[1][i] = corners[2][i] = high[i];
      corners[2][j] = corners[3][j] = high[j];
      if (!upper) std::swap(corners[1], corners[3]);
      triangles.push_back({corners[0], corners[1], corners[2]});
      triangles.push_back({corners[0], corners[2], corners[3]});
    }
  return triangles;
}

inline triangle_list unit_cube() {
  return cuboid({0, 0, 0}, {1, 1, 1});
}

/// Returns an icosahedron with corners at the distance r from the origin; each level divides
/// triangles into four.
inline triangle_list icosphere(double radius, int levels) {
  const double g = 0.5 * (1.0 + std::sqrt(5.0));
  const std::vector<position> p = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                                   {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  const int faces[20][3] = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                            {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                            {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                            {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
  const auto on_sphere = [radius](const position& x) {
    const double scale = radius / std::hypot(x[0], x[1], x[2]);
    return position{scale * x[0], scale * x[1], scale * x[2]};
  };
  triangle_list triangles;
  for (const auto& f : faces) {
    const auto at = [&](int n) { return on_sphere(p[static_cast<std::size_t>(f[n])]); };
    triangles.push_back({at(0), at(1), at(2)});
  }
  for (int level = 0; level < levels; ++level) {
    triangle_list finer;
    const auto middle = [&](const position& a, const position& b) {
      return on_sphere({a[0] + b[0], a[1] + b[1], a[2] + b[2]});
    };
    for (const auto& [a, b, c] : triangles) {
      const position ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    triangles = std::move(finer);
  }
  return triangles;
}

/// Reverses the orientation of the surface.
inline triangle_list reversed(triangle_list triangles) {
  for (auto& triangle : triangles) std::swap(triangle[1], triangle[2]);
  return triangles;
}

inline triangle_list joined(triangle_list first, const triangle_list& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

/// Writes a file into the folder of temporary files, and returns its path.
inline std::string written(const std::string& name, const std::string& bytes) {
  std::string path = testing::TempDir() + "apsis_body_" + name;
  std::ofstream(path, std::ios::binary) << bytes;
  return path;
}

inline std::string ascii_stl(const triangle_list& triangles) {
  std::string text = "solid of a test\n";
  for (const auto& triangle : triangles) {
    text += " facet normal 0 0 0\n  outer loop\n";
    for (const position& x : triangle) text += fmt::format("   vertex {} {} {}\n", x[0], x[1], x[2]);
    text += "  endloop\n endfacet\n";
  }
  return text + "endsolid of a test\n";
}

inline void append_word(std::string& bytes, std::uint32_t word) {
  for (int k = 0; k < 4; ++k) bytes += static_cast<char>((word >> (8 * k)) & 0xFFU);
}

inline std::string binary_stl(const triangle_list& triangles, std::string header = "solid, in name only") {
  header.resize(80, ' ');
  std::string bytes = std::move(header);
  append_word(bytes, static_cast<std::uint32_t>(triangles.size()));
  for (const auto& triangle : triangles) {
    bytes.append(12, '\0');
    for (const position& corner : triangle)
      for (const double x : corner) append_word(bytes, std::bit_cast<std::uint32_t>(static_cast<float>(x)));
    bytes.append(2, '\0');
  }
  return bytes;
}

}  // namespace body_triangles
