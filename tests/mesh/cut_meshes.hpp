#pragma once

// Bodies and meshes for tests of cut cells, and properties of every cut mesh.
#include <apsis/core/index.hpp>
#include <apsis/mesh/cut_cells.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include <gtest/gtest.h>

namespace cut_cells_test {

using apsis::cut_cells;
using apsis::grid;
using apsis::outside_function;
using apsis::position;

inline constexpr std::array<bool, 3> closed = {false, false, false};

inline outside_function disc(double x, double y, double r) {
  return [=](const position& at) { return std::hypot(at[0] - x, at[1] - y) - r; };
}

inline outside_function ball(double x, double y, double z, double r) {
  return [=](const position& at) { return std::hypot(at[0] - x, at[1] - y, at[2] - z) - r; };
}

/// Returns the body with n·x < c.
inline outside_function half_space(std::array<double, 3> n, double c) {
  return [=](const position& at) { return n[0] * at[0] + n[1] * at[1] + n[2] * at[2] - c; };
}

/// Returns a square of side 2a about (x, y), turned by an angle.
inline outside_function turned_square(double x, double y, double a, double angle) {
  return [=](const position& at) {
    const double c = std::cos(angle), s = std::sin(angle), dx = at[0] - x, dy = at[1] - y;
    return std::max(std::abs(c * dx + s * dy), std::abs(c * dy - s * dx)) - a;
  };
}

inline grid plane(int n, double a = -2.0, double b = 2.0) {
  return grid(2, {n, n, 1}, {a, a, 0}, {b, b, 1});
}

inline grid space(int n) {
  return grid(3, {n, n, n}, {-2, -2, -2}, {2, 2, 2});
}

inline double gas_volume(const grid& mesh, const cut_cells& cut) {
  double volume = 0.0;
  for (int cell = 0; cell < mesh.size(); ++cell)
    if (cut.group_of(cell) < 0 && cut.body_of(cell) < 0 && mesh.solid(cell) < 0) volume += mesh.cell_volume();
  for (const auto& group : cut.groups()) volume += group.volume;
  return volume;
}

inline double wall_area(const cut_cells& cut) {
  double area = 0.0;
  for (const auto& wall : cut.walls()) area += wall.area;
  return area;
}

/// Returns the largest defect of Σ area × normal over the faces and walls of a group.
inline double defect_of_closure(const cut_cells& cut) {
  double most = 0.0;
  for (std::size_t g = 0; g < cut.groups().size(); ++g) {
    const auto& group = cut.groups()[g];
    std::array<double, 3> sum{};
    for (const int f : group.faces) {
      const auto& face = cut.faces()[apsis::at(f)];
      const bool is_below = face.below >= 0 && cut.group_of(face.below) == static_cast<int>(g);
      sum[apsis::at(face.direction)] += is_below ? face.area : -face.area;
    }
    for (const int w : group.walls)
      for (std::size_t k = 0; k < 3; ++k)
        sum[k] -= cut.walls()[apsis::at(w)].area * cut.walls()[apsis::at(w)].normal[k];
    for (const double x : sum) most = std::max(most, std::abs(x));
  }
  return most;
}

/// Expects that every group is large enough and closed, and that its volume is that of its cells.
inline void expect_sound(const grid& mesh, const cut_cells& cut) {
  const double area = std::pow(mesh.spacing(0), mesh.dimensions() - 1);
  EXPECT_LT(defect_of_closure(cut), 1e-13 * area);  // sums of some ten areas of this size
  for (std::size_t g = 0; g < cut.groups().size(); ++g) {
    const auto& group = cut.groups()[g];
    EXPECT_LE(cut.outflow(static_cast<int>(g)), 1.0);
    double volume = 0.0;
    for (const int cell : group.cells) {
      EXPECT_EQ(cut.group_of(cell), static_cast<int>(g));
      volume += cut.volume_of(cell);
    }
    EXPECT_NEAR(volume, group.volume, 1e-14 * mesh.cell_volume());
  }
  for (const auto& face : cut.faces()) EXPECT_GT(face.area, 0.0);
}

/// Returns the observed order, log2 of the ratio of two errors. The fine mesh has twice as many cells.
inline double order_of(double coarse, double fine) {
  return std::log2(std::abs(coarse) / std::abs(fine));
}

}  // namespace cut_cells_test
