// Gaussians with correlated components on velocity grids.
#include <apsis/model/correlated_gaussian.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <Eigen/Dense>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace correlated_gaussian_test {

namespace {

double number(double from, double to) {
  return from + (to - from) * *rc::gen::inRange(0, 10'001) / 1e4;
}

/// Returns velocities that are three times as dense at rest as at the ends.
apsis::velocity_line dense_at_rest(int points, double end) {
  std::vector<double> v;
  for (int j = 0; j < points; ++j) {
    const double x = (2.0 * j + 1.0 - points) / points;
    v.push_back(end * x * (0.5 + 0.5 * std::abs(x)));
  }
  return {v, std::vector<double>(v.size(), 1.0)};
}

apsis::direction_matrix plain(const Eigen::MatrixXd& of) {
  apsis::direction_matrix same{};
  for (int k = 0; k < of.rows(); ++k)
    for (int l = 0; l < of.cols(); ++l) same.of[k][l] = of(k, l);
  return same;
}

}  // namespace

RC_GTEST_PROP(correlated_gaussian, is_its_formula_at_every_velocity, ()) {
  const int d = *rc::gen::inRange(1, 4);
  // Narrow Gaussians leave the range of the product of tables.
  const double width = *rc::gen::element(0.02, 0.3, 1.0);
  std::vector<apsis::velocity_line> lines;
  // Up to 100 velocities per direction: walks over dense rows are inaccurate, and are not taken.
  const int most = d == 3 ? 20 : 100;
  for (int k = 0; k < d; ++k) {
    const double end = number(3.0, 8.0);
    const int points = *rc::gen::inRange(4, most);
    lines.push_back(*rc::gen::inRange(0, 4) == 0 ? dense_at_rest(points, end)
                                                 : apsis::velocity_line(points, end));
  }
  const bool rings = d == 3 && *rc::gen::arbitrary<bool>();
  const apsis::velocity_grid grid =
      rings ? apsis::velocity_grid(lines.front(), {*rc::gen::inRange(4, 8), 12, number(3.0, 8.0)},
                                   *rc::gen::element(0, 2))
            : apsis::velocity_grid(lines);
  apsis::fluid_state state;
  state.rho = number(0.1, 3.0);
  state.T = width * width;
  Eigen::MatrixXd root(d, d);
  for (int k = 0; k < d; ++k) {
    state.u[k] = number(-1.0, 1.0);
    for (int l = 0; l < d; ++l) root(k, l) = number(-0.4, 0.4) + (k == l ? 1.0 : 0.0);
  }
  const Eigen::MatrixXd covariance = width * width * (root * root.transpose());
  RC_PRE(covariance.determinant() > 0.01 * std::pow(width, 2.0 * d));
  const Eigen::MatrixXd inverse = covariance.inverse();
  std::vector<double> m(static_cast<std::size_t>(grid.size()));
  apsis::correlated_gaussian(grid, state, plain(covariance), plain(inverse), m.data());
  const double height = state.rho / std::sqrt(std::pow(2.0 * std::numbers::pi, d) * covariance.determinant());
  for (int j = 0; j < grid.size(); ++j) {
    Eigen::VectorXd c(d);
    for (int k = 0; k < d; ++k) c[k] = grid.component(k)[static_cast<std::size_t>(j)] - state.u[k];
    const double exact = height * std::exp(-0.5 * c.dot(inverse * c));
    // Exponents up to 700 are rounded in sums, whose terms are larger where components correlate.
    // Values below 1e-300 are set to 0. So are exponentials below exp(-690) < 3e-300, whose factor is
    // at most the height.
    RC_ASSERT(std::abs(m[static_cast<std::size_t>(j)] - exact) <=
              1e-11 * exact + 3e-300 * std::max(1.0, height));
  }
}

}  // namespace correlated_gaussian_test
