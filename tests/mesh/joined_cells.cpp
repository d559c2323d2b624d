// Small cells that join their neighbours.
#include <apsis/mesh/cut_cells.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>
#include <mesh/cut_meshes.hpp>

namespace joined_cells_test {
namespace {

using namespace cut_cells_test;

std::size_t largest_group(const cut_cells& cut) {
  std::size_t most = 0;
  for (const auto& group : cut.groups()) most = std::max(most, group.cells.size());
  return most;
}

/// Returns sorted triples (x, y, volume) of the groups, with these signs of x and y.
std::vector<std::array<double, 3>> placed_groups(const cut_cells& cut, double sign_x, double sign_y) {
  std::vector<std::array<double, 3>> all;
  // Rounding errors must not change the order.
  const auto rounded = [](double x) { return std::round(x * 1e9) * 1e-9; };
  for (const auto& group : cut.groups())
    all.push_back(
        {rounded(sign_x * group.centre[0]), rounded(sign_y * group.centre[1]), rounded(group.volume)});
  std::sort(all.begin(), all.end());
  return all;
}

}  // namespace

/// Triangles along a wall at 45° have two equal open faces. Two triangles share each of these neighbours.
TEST(joined_cells, along_a_diagonal_wall_are_few) {
  constexpr double r = 0.5 * std::numbers::sqrt2;
  for (const double offset : {0.01, 0.02, 0.05, 0.1, 0.15}) {
    for (const std::array<double, 3> n : {std::array{r, r, 0.0}, {-r, r, 0.0}, {r, -r, 0.0}, {-r, -r, 0.0}}) {
      const grid mesh = plane(32);
      const cut_cells cut(mesh, {half_space(n, offset)}, closed);
      expect_sound(mesh, cut);
      EXPECT_LE(largest_group(cut), 3U) << offset;
      EXPECT_GT(cut.groups().size(), 20U);
    }
  }
  const double third = 1.0 / std::sqrt(3.0);
  for (const double offset : {0.02, 0.1, 0.2}) {
    for (const std::array<double, 3> n :
         {std::array{third, third, third}, {0.0, r, r}, {-third, third, third}}) {
      const cut_cells cut(space(12), {half_space(n, offset)}, closed);
      expect_sound(space(12), cut);
      EXPECT_LE(largest_group(cut), 4U) << offset;
    }
  }
}

TEST(joined_cells, of_a_body_with_diagonal_walls_are_mirrored) {
  for (const int n : {20, 25, 32}) {
    const auto diamond = [](const position& x) { return std::abs(x[0]) + std::abs(x[1]) - 1.13; };
    const cut_cells cut(plane(n), {diamond}, closed);
    expect_sound(plane(n), cut);
    EXPECT_LE(largest_group(cut), 4U);
    const auto groups = placed_groups(cut, 1.0, 1.0);
    for (const auto& mirrored : {placed_groups(cut, -1.0, 1.0), placed_groups(cut, 1.0, -1.0)}) {
      ASSERT_EQ(groups.size(), mirrored.size());
      for (std::size_t k = 0; k < groups.size(); ++k)
        for (std::size_t d = 0; d < 3; ++d) EXPECT_NEAR(groups[k][d], mirrored[k][d], 2e-9);
    }
  }
}

/// A wall that halves a cell from corner to corner has the outflow 1 up to rounding. The corners at (0.6,
/// 0.8) and (0.8, 0.6) lie on the circle.
TEST(joined_cells, do_not_depend_on_rounding_where_a_wall_halves_a_cell) {
  for (const auto& [n, end] : {std::pair{20, 2.0}, {30, 3.0}, {70, 7.0}}) {
    const cut_cells cut(plane(n, -end, end), {disc(0, 0, 1)}, closed);
    const auto groups = placed_groups(cut, 1.0, 1.0);
    for (const auto& mirrored : {placed_groups(cut, -1.0, 1.0), placed_groups(cut, 1.0, -1.0)}) {
      ASSERT_EQ(groups.size(), mirrored.size()) << n;
      for (std::size_t k = 0; k < groups.size(); ++k)
        for (std::size_t d = 0; d < 3; ++d) EXPECT_NEAR(groups[k][d], mirrored[k][d], 2e-9) << n;
    }
  }
}

}  // namespace joined_cells_test
