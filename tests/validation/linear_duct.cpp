#include "linear_duct.hpp"
#include "rectangle_flights.hpp"

#include <cmath>

#include <Eigen/LU>

namespace validation_test {

using Eigen::MatrixXd;
using Eigen::VectorXd;

linear_duct::linear_duct(double delta, double aspect, int n) {
  const rectangle_flights flights(delta, n, aspect, 1.0);
  const velocity_function one = [](double, double) { return std::array{1.0, 0.0}; };
  const velocity_function heat = [](double x, double y) { return std::array{1.0 - x * x - y * y, 0.0}; };
  const MatrixXd collided = flights.inside(one, one);
  // The constant 1 is a multiple of the first polynomial.
  VectorXd constant = VectorXd::Zero(n * n);
  constant[0] = std::sqrt(aspect);
  MatrixXd driven(n * n, 2);
  driven << 0.5 * collided * constant, 0.5 * flights.inside(one, heat) * constant;
  const MatrixXd u = (MatrixXd::Identity(n * n, n * n) - delta * collided).partialPivLu().solve(driven);
  flow_ = 2.0 * constant.dot(u.col(0)) / aspect;
  creep_ = 2.0 * constant.dot(u.col(1)) / aspect;
}

}  // namespace validation_test
