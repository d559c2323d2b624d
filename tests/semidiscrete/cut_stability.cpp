// Transport beside bodies does not grow: the eigenvalues of its derivative have negative real parts.
#include <apsis/semidiscrete/cut_transport.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>
#include <semidiscrete/gas_past_bodies.hpp>

namespace cut_stability_test {
namespace {

using namespace gas_past_bodies_test;

/// Returns a body beside gas in n·x > 0.1, where n = (cos, sin) of an angle in degrees.
outside_function half_plane(double degrees) {
  const double c = std::cos(degrees * std::acos(-1.0) / 180.0),
               s = std::sin(degrees * std::acos(-1.0) / 180.0);
  return [=](const position& at) { return c * at[0] + s * at[1] - 0.1; };
}

/// Returns the largest real part of an eigenvalue of ∂T/∂f at f = 1, for a single component.
double largest_growth(const gas_past_bodies& gas, int component) {
  const grid& mesh = gas.mesh();
  std::vector<int> unknowns;
  for (int cell = 0; cell < mesh.size(); ++cell)
    if (apsis::has_unknown(mesh, cell)) unknowns.push_back(cell);
  field f(mesh.size(), gas.equation->components());
  for (int cell = 0; cell < mesh.size(); ++cell)
    if (mesh.solid(cell) < 0) std::fill_n(f.row(cell), f.components(), 1.0);
  const field before = gas.step(f, 0.0, 1.0);
  constexpr double change = 1e-4;  // T is linear up to a factor 1 − O(change⁸)
  const auto n = static_cast<Eigen::Index>(unknowns.size());
  Eigen::MatrixXd derivative(n, n);
  for (Eigen::Index j = 0; j < n; ++j) {
    const int cell = unknowns[apsis::at(static_cast<int>(j))], group = mesh.cut_group(cell);
    const std::vector<int> cells =
        group < 0 ? std::vector{cell} : mesh.cut()->groups()[apsis::at(group)].cells;
    for (const int one : cells) f.row(one)[component] += change;
    const field after = gas.step(f, 0.0, 1.0);
    for (const int one : cells) f.row(one)[component] = 1.0;
    for (Eigen::Index i = 0; i < n; ++i) {
      const int row = unknowns[apsis::at(static_cast<int>(i))];
      derivative(i, j) = (after.row(row)[component] - before.row(row)[component]) / change;
    }
  }
  return Eigen::EigenSolver<Eigen::MatrixXd>(derivative, false).eigenvalues().real().maxCoeff();
}

}  // namespace

/// If ghosts of entering components were values of a parabola through downstream cells, a mode would grow. At
/// 45° it grows along the normal at the rate 0.13 |v|/Δx.
TEST(cut_stability, of_a_wall_at_any_angle) {
  for (const double angle : {45.0, 225.0, 35.0, 60.0}) {
    const gas_past_bodies gas = make({.cells = 16,
                                      .bodies = {half_plane(angle)},
                                      .scheme = "upwind5",
                                      .boundary = "vacuum",
                                      .limited = false});
    const auto x = gas.equation->speeds(0), y = gas.equation->speeds(1);
    int seen = 0;
    const int velocities = static_cast<int>(gas.equation->velocities().weights().size());
    for (int k = 0; k < velocities; ++k) {
      // Only fast velocities count, because all are multiples of few directions.
      const double speed = std::hypot(x[apsis::at(k)], y[apsis::at(k)]);
      if (speed < 3.5 || speed > 4.2) continue;
      ++seen;
      EXPECT_LT(largest_growth(gas, k), -0.01 * speed / gas.mesh().spacing(0))
          << angle << " degrees, v = " << x[apsis::at(k)] << ", " << y[apsis::at(k)];
    }
    EXPECT_GT(seen, 7);
  }
}

}  // namespace cut_stability_test
