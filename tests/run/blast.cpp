// A blast from a point in the plane and in space. The flow is a function of the radius, independent
// of the axes.
#include "laws.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <fmt/ranges.h>
#include <gtest/gtest.h>

namespace blast_test {

namespace {

/// The upper right quarter of the plane between planes of symmetry; the blast does not reach the outer faces.
const char* const quarter = R"toml(
[model]
name = "bgk"
[initial]
rho = "1 + exp(-15*(x^2 + y^2))"
u = [0, 0]
T = "1 + 0.2*exp(-15*(x^2 + y^2))"
[space]
domain = [[0, 1], [0, 1]]
boundary = "symmetry"
[velocity]
max = 6.8
points = 14
[time]
method = "md-imex-3-2"
end = 0.06
cfl = 0.8
)toml";

const overrides eighth_of_space = {"time.end=0.03",
                                   "initial.rho=1 + exp(-15*(x^2 + y^2 + z^2))",
                                   "initial.u=[0,0,0]",
                                   "initial.T=1 + 0.2*exp(-15*(x^2 + y^2 + z^2))",
                                   "space.domain=[[0,1],[0,1],[0,1]]",
                                   "velocity.points=12"};

/// Returns the mean deviation of density, radial velocity and temperature from their means over cells with
/// the same distance from the origin. It adds the mean velocity across the radius. Only cells with a radius
/// below 0.7 count.
double anisotropy(const apsis::simulation& run) {
  const auto fields = run.fields();
  const auto d = fields.shape.size();
  const int n = fields.shape[0];
  std::map<int, std::vector<std::array<double, 3>>> by_radius;
  double across = 0.0;
  int count = 0;
  for (int cell = 0; cell < run.mesh().size(); ++cell) {
    const auto x = run.mesh().centre(cell);
    double square = 0.0, radial = 0.0, speed = 0.0;
    int key = 0;  // 4 n² r², an integer
    for (std::size_t k = 0; k < d; ++k) {
      const int odd = 2 * static_cast<int>(x[k] * n) + 1;
      const double u = fields.values[1 + k][static_cast<std::size_t>(cell)];
      key += odd * odd;
      square += x[k] * x[k];
      radial += u * x[k];
      speed += u * u;
    }
    if (square > 0.49) continue;
    radial /= std::sqrt(square);
    across += std::sqrt(std::max(speed - radial * radial, 0.0));
    by_radius[key].push_back({fields.values[0][static_cast<std::size_t>(cell)], radial,
                              fields.values[1 + d][static_cast<std::size_t>(cell)]});
    ++count;
  }
  double sum = across;
  for (const auto& [key, values] : by_radius)
    for (std::size_t field = 0; field < 3; ++field) {
      double mean = 0.0;
      for (const auto& one : values) mean += one[field] / static_cast<double>(values.size());
      for (const auto& one : values) sum += std::abs(one[field] - mean);
    }
  return sum / count;
}

/// Expects that the anisotropy decreases with an order when twice as many cells along each
/// direction are used.
void expect_order(double order, int cells, int dimensions, const std::string& epsilon,
                  const overrides& changes = {}) {
  const auto of_mesh = [&](int n) {
    overrides all = changes;
    const std::vector<int> mesh(static_cast<std::size_t>(dimensions), n);
    all.insert(all.end(),
               {fmt::format("space.cells=[{}]", fmt::join(mesh, ",")), "model.epsilon=" + epsilon});
    return anisotropy(finished_run(quarter, all));
  };
  const double coarse = of_mesh(cells), fine = of_mesh(2 * cells);
  testing::Test::RecordProperty("at_" + epsilon,
                                fmt::format("{:.2g} {:.2f}", fine, std::log2(coarse / fine)));
  EXPECT_GT(std::log2(coarse / fine), order) << epsilon << ": " << coarse << " " << fine;
}

/// A symmetry of the fields. `image` maps the numbers (i, j) of a cell. If `swaps`, the components of u are
/// exchanged. They get the signs.
struct symmetry {
  const char* name;
  std::pair<int, int> (*image)(int i, int j, int last);
  bool swaps;
  double sign_x, sign_y;
};

const std::array<symmetry, 3> symmetries = {
    {{"left and right", [](int i, int j, int last) { return std::pair{last - i, j}; }, false, -1.0, 1.0},
     {"below and above", [](int i, int j, int last) { return std::pair{i, last - j}; }, false, 1.0, -1.0},
     {"diagonal", [](int i, int j, int) { return std::pair{j, i}; }, true, 1.0, 1.0}}};

double difference_from(const symmetry& of, const apsis::field_table& fields) {
  const int n = fields.shape[0];
  double largest = 0.0;
  const auto value = [&](std::size_t field, int i, int j) {
    return fields.values[field][static_cast<std::size_t>(i * n + j)];
  };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const auto [a, b] = of.image(i, j, n - 1);
      const double u = value(of.swaps ? 2 : 1, a, b), v = value(of.swaps ? 1 : 2, a, b);
      largest = std::max({largest, std::abs(value(0, a, b) - value(0, i, j)),
                          std::abs(value(3, a, b) - value(3, i, j)), std::abs(of.sign_x * u - value(1, i, j)),
                          std::abs(of.sign_y * v - value(2, i, j))});
    }
  return largest;
}

}  // namespace

TEST(blast, in_the_plane_becomes_a_function_of_the_radius_with_the_order_of_the_scheme) {
  for (const char* epsilon : {"1e12", "0.01", "0"}) expect_order(4.8, 12, 2, epsilon);
}

TEST(blast, in_space_becomes_a_function_of_the_radius) {
  // Six cells are too few to resolve the blast fully.
  overrides small = eighth_of_space;
  small.emplace_back("velocity.points=10");
  expect_order(1.5, 6, 3, "0", small);
}

TEST(SLOW_blast, in_space_becomes_a_function_of_the_radius_with_the_order_of_the_scheme) {
  for (const char* epsilon : {"1e12", "0.01", "0"}) expect_order(4.5, 12, 3, epsilon, eighth_of_space);
}

TEST(blast, has_the_symmetries_of_the_mesh_to_rounding) {
  for (const std::string epsilon : {"1e12", "0.01", "0"}) {
    const auto fields = finished_run(quarter, {"space.cells=[18,18]", "space.domain=[[-1,1],[-1,1]]",
                                               "space.boundary=outflow", "space.limiter=positivity",
                                               "model.degrees_of_freedom=3", "model.epsilon=" + epsilon})
                            .fields();
    // Sums over velocities have another order, and WENO weights divide by squares of differences.
    for (const symmetry& one : symmetries)
      EXPECT_LT(difference_from(one, fields), 1e-13) << one.name << epsilon;
  }
}

}  // namespace blast_test
