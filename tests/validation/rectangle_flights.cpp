#include "rectangle_flights.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Eigenvalues>

namespace validation_test {
namespace {

using Eigen::ArrayXd;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int speeds = 100;

struct quadrature {
  VectorXd at, weight;
};

/// Returns the Gauss–Legendre points of [0, 1], the eigenvalues of the Jacobi matrix.
quadrature gauss(int points) {
  MatrixXd jacobi = MatrixXd::Zero(points, points);
  for (int k = 1; k < points; ++k)
    jacobi(k, k - 1) = jacobi(k - 1, k) = 0.5 * k / std::sqrt(4.0 * k * k - 1.0);
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solved(jacobi);
  return {solved.eigenvalues().array() + 0.5, solved.eigenvectors().row(0).array().square()};
}

int axis_of(side s) {
  return s == side::left || s == side::right ? 0 : 1;
}

bool upper(side s) {
  return s == side::right || s == side::top;
}

/// Returns the direction into the gas along the axis of a side.
double inward(side s) {
  return upper(s) ? -1.0 : 1.0;
}

velocity_function reversed(const velocity_function& f) {
  return [f](double x, double y) { return f(-x, -y); };
}

/// Moves [i n + k][j] to [i n + j][k], or [j n + k][i] to [i n + j][k].
MatrixXd with_wall(const MatrixXd& found, int n, int wall_axis) {
  MatrixXd out(n * n, n);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      for (int k = 0; k < n; ++k)
        out(i * n + j, k) = wall_axis == 1 ? found(i * n + k, j) : found(j * n + k, i);
  return out;
}

}  // namespace

rectangle_flights::rectangle_flights(double delta, int n, double width, double height)
    : delta_(delta), width_(width), height_(height), n_(n), speed_(speeds), speed_weight_(speeds) {
  for (int j = 0; j < speeds; ++j) {
    const double s = (j + 0.5) / speeds, t = 6.0 * s * s * s;
    speed_[j] = t;
    speed_weight_[j] = 18.0 * s * s / speeds * std::exp(-t * t);
  }
  set_differences();
  kept_ = kept(distance_);
  for (int axis : {0, 1})
    correlations_[static_cast<std::size_t>(axis)] =
        correlations(axis, distance_.array() * direction_.col(axis).array());
}

void rectangle_flights::set_differences() {
  const quadrature radii = gauss(2 * n_ + 8), angles = gauss(n_ + 8);
  const auto of_triangle = radii.at.size() * angles.at.size(), total = 8 * of_triangle;
  distance_.resize(total);
  weight_.resize(total);
  direction_.resize(total, 2);
  const double diagonal = std::atan2(height_, width_);
  Eigen::Index q = 0;
  for (int triangle = 0; triangle < 8; ++triangle) {
    // Angles are from the axis x in the first quadrant, up to the diagonal or beyond it.
    const bool flat = triangle % 2 == 0;
    const double begin = flat ? 0.0 : diagonal, span = flat ? diagonal : 0.5 * std::numbers::pi - diagonal;
    const double sign_x = triangle % 4 < 2 ? 1.0 : -1.0, sign_y = triangle < 4 ? 1.0 : -1.0;
    for (Eigen::Index a = 0; a < angles.at.size(); ++a) {
      const double angle = begin + span * angles.at[a], x = std::cos(angle), y = std::sin(angle);
      const double longest = flat ? width_ / x : height_ / y;
      for (Eigen::Index r = 0; r < radii.at.size(); ++r, ++q) {
        const double s = radii.at[r];
        distance_[q] = longest * s * s * s;
        weight_[q] = span * angles.weight[a] * longest * 3.0 * s * s * radii.weight[r];
        direction_.row(q) << sign_x * x, sign_y * y;
      }
    }
  }
}

MatrixXd rectangle_flights::kept(const VectorXd& distance) const {
  MatrixXd out(distance.size(), speeds);
  for (int j = 0; j < speeds; ++j)
    out.col(j) = speed_weight_[j] * (-delta_ / speed_[j] * distance.array()).exp();
  return out;
}

VectorXd rectangle_flights::kernel(const MatrixXd& kept, const MatrixXd& direction, int ends,
                                   const velocity_function& f, const velocity_function& g) const {
  VectorXd out = VectorXd::Zero(kept.rows());
  for (int j = 0; j < speeds; ++j) {
    const double t = speed_[j], power = ends == 0 ? 1.0 : ends == 1 ? t : t * t;
    for (Eigen::Index q = 0; q < out.size(); ++q) {
      const auto a = f(t * direction(q, 0), t * direction(q, 1)),
                 b = g(t * direction(q, 0), t * direction(q, 1));
      out[q] += power * kept(q, j) * (a[0] * b[0] + a[1] * b[1]);
    }
  }
  return out / std::numbers::pi;
}

MatrixXd rectangle_flights::polynomials(int axis, const VectorXd& at) const {
  const double size = length(axis);
  const ArrayXd x = 2.0 * at.array() / size - 1.0;
  MatrixXd out(at.size(), n_);
  out.col(0).setOnes();
  out.col(1) = x;
  for (int k = 2; k < n_; ++k)
    out.col(k) = ((2.0 * k - 1.0) * x * out.col(k - 1).array() - (k - 1.0) * out.col(k - 2).array()) / k;
  for (int k = 0; k < n_; ++k) out.col(k) *= std::sqrt((2.0 * k + 1.0) / size);
  return out;
}

MatrixXd rectangle_flights::correlations(int axis, const VectorXd& d) const {
  const quadrature exact = gauss(n_);
  MatrixXd out(d.size(), n_ * n_);
  for (Eigen::Index q = 0; q < d.size(); ++q) {
    const double overlap = length(axis) - std::abs(d[q]);
    const VectorXd x = overlap * exact.at.array() + std::max(0.0, -d[q]);
    const MatrixXd there = polynomials(axis, x.array() + d[q]), here = polynomials(axis, x),
                   product = there.transpose() * (overlap * exact.weight).asDiagonal() * here;
    for (int i = 0; i < n_; ++i) out.row(q).segment(i * n_, n_) = product.row(i);
  }
  return out;
}

MatrixXd rectangle_flights::inside(const velocity_function& received,
                                   const velocity_function& started) const {
  const VectorXd weight = weight_.cwiseProduct(kernel(kept_, direction_, 0, received, started));
  const MatrixXd found = correlations_[0].transpose() * weight.asDiagonal() * correlations_[1];
  MatrixXd out(n_ * n_, n_ * n_);
  for (int i = 0; i < n_; ++i)
    for (int j = 0; j < n_; ++j)
      for (int k = 0; k < n_; ++k)
        for (int l = 0; l < n_; ++l) out(i * n_ + j, k * n_ + l) = found(i * n_ + k, j * n_ + l);
  return out;
}

MatrixXd rectangle_flights::from_side(side from, const velocity_function& received,
                                      const velocity_function& started) const {
  const int normal = axis_of(from), along = 1 - normal;
  const ArrayXd leaving = (inward(from) * direction_.col(normal).array()).max(0.0);  // cos θ, or 0 backwards
  const VectorXd weight = leaving * weight_.array() * kernel(kept_, direction_, 1, received, started).array();
  const ArrayXd away = distance_.array() * leaving;
  const VectorXd place = upper(from) ? (length(normal) - away).eval() : away;
  return with_wall(correlations_[static_cast<std::size_t>(along)].transpose() * weight.asDiagonal() *
                       polynomials(normal, place),
                   n_, normal);
}

MatrixXd rectangle_flights::to_side(side to, const velocity_function& received,
                                    const velocity_function& started) const {
  // The flights are the same, backwards.
  return from_side(to, reversed(started), reversed(received)).transpose();
}

MatrixXd rectangle_flights::between(side to, side from, const velocity_function& received,
                                    const velocity_function& started) const {
  if (to == from) return MatrixXd::Zero(n_, n_);
  if (axis_of(to) == axis_of(from)) return to_opposite(from, received, started);
  // The points of both sides have a common corner. Their differences are those of a quadrant.
  const int normal = axis_of(from), along = axis_of(to);
  const ArrayXd leaving = (inward(from) * direction_.col(normal).array()).max(0.0),
                arriving = (-inward(to) * direction_.col(along).array()).max(0.0);
  const VectorXd weight =
      leaving * arriving * weight_.array() * kernel(kept_, direction_, 2, received, started).array();
  const auto place = [&](side corner, int axis, const ArrayXd& away) -> VectorXd {
    return upper(corner) ? (length(axis) - away).eval() : away;
  };
  const VectorXd start = place(to, along, distance_.array() * arriving),
                 end = place(from, normal, distance_.array() * leaving);
  return polynomials(normal, end).transpose() * weight.asDiagonal() * polynomials(along, start);
}

MatrixXd rectangle_flights::to_opposite(side from, const velocity_function& received,
                                        const velocity_function& started) const {
  const int normal = axis_of(from), along = 1 - normal;
  const quadrature half = gauss(2 * n_ + 20);
  const Eigen::Index m = half.at.size();
  VectorXd d(2 * m), weight(2 * m);
  d << length(along) * half.at, -length(along) * half.at;
  weight << length(along) * half.weight, length(along) * half.weight;
  const ArrayXd distance = (d.array().square() + length(normal) * length(normal)).sqrt();
  MatrixXd direction(2 * m, 2);
  direction.col(along) = d.array() / distance;
  direction.col(normal) = inward(from) * length(normal) / distance;
  const ArrayXd cosine = length(normal) / distance;
  weight.array() *=
      cosine.square() / distance * kernel(kept(distance), direction, 2, received, started).array();
  const VectorXd found = correlations(along, d).transpose() * weight;
  return Eigen::Map<const Eigen::Matrix<double, -1, -1, Eigen::RowMajor>>(found.data(), n_, n_);
}

}  // namespace validation_test
