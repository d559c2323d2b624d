#include "linear_square.hpp"

#include <cmath>
#include <numbers>

#include <Eigen/LU>

namespace validation_test {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using part = std::array<double, 2>;

constexpr std::array sides = {side::left, side::right, side::bottom, side::top};

/// 1, √2 c_x, √2 c_y and √(2/3) (c² − 3/2), orthonormal, with c² = c_x² + c_y² + c_z².
const std::array<velocity_function, 4> invariants = {
    [](double, double) { return part{1.0, 0.0}; },
    [](double x, double) { return part{std::numbers::sqrt2 * x, 0.0}; },
    [](double, double y) { return part{std::numbers::sqrt2 * y, 0.0}; },
    [](double x, double y) {
      return part{std::sqrt(2.0 / 3.0) * (x * x + y * y - 1.0), std::sqrt(1.0 / 3.0)};
    }};

/// Emission of a moving side, 2 c_x, and of a hot one, c² − 2. The latter carries no mass through the side.
const velocity_function moving = [](double x, double) { return part{2.0 * x, 0.0}; };
const velocity_function hot = [](double x, double y) {
  return part{x * x + y * y - 1.5, 1.0 / std::numbers::sqrt2};
};

/// The linear system of the moments inside, invariant by invariant, and of the densities at the sides.
class system_of_square {
 public:
  system_of_square(double delta, int n) : delta_(delta), n_(n), inside_(4 * n * n), flights_(delta, n) {
    const Eigen::Index size = inside_ + 4 * n;
    MatrixXd received(size, size);
    for (std::size_t k = 0; k < 4; ++k) {
      received.middleRows(field(k), n * n) = arriving_inside(invariants[k]);
      received.middleRows(wall(k), n) = per_density * arriving_at(sides[k], invariants[0]);
    }
    MatrixXd system = MatrixXd::Identity(size, size) - received;
    // A constant density solves the system. The mean density is set to 0, which changes nothing else.
    VectorXd constant = VectorXd::Zero(size);
    constant[field(0)] = 1.0;
    for (std::size_t k = 0; k < 4; ++k) constant[wall(k)] = 1.0;
    system += constant * constant.transpose();
    solver_.compute(system);
  }

  /// Returns the moments and densities for an emission of the top.
  VectorXd solve(const velocity_function& emitted) const {
    VectorXd source(inside_ + 4 * n_);
    for (std::size_t k = 0; k < 4; ++k) {
      source.segment(field(k), n_ * n_) = flights_.from_side(side::top, invariants[k], emitted).col(0);
      source.segment(wall(k), n_) =
          per_density * flights_.between(sides[k], side::top, invariants[0], emitted).col(0);
    }
    return solver_.solve(source);
  }

  /// Returns the mean flux of a function through a side, with `emitted` from the top.
  double flux(side to, const velocity_function& f, const VectorXd& solution,
              const velocity_function& emitted) const {
    return arriving_at(to, f).row(0) * solution + flights_.between(to, side::top, f, emitted)(0, 0);
  }

 private:
  /// One over the flux ⟨c_n⟩ of density 1 that leaves a side.
  static constexpr double per_density = 2.0 / std::numbers::inv_sqrtpi;

  Eigen::Index field(std::size_t k) const { return static_cast<Eigen::Index>(k) * n_ * n_; }
  Eigen::Index wall(std::size_t k) const { return inside_ + static_cast<Eigen::Index>(k) * n_; }

  /// Returns the moment of f inside, for every unknown.
  MatrixXd arriving_inside(const velocity_function& f) const {
    MatrixXd out(n_ * n_, inside_ + 4 * n_);
    for (std::size_t k = 0; k < 4; ++k) {
      out.middleCols(field(k), n_ * n_) = delta_ * flights_.inside(f, invariants[k]);
      out.middleCols(wall(k), n_) = flights_.from_side(sides[k], f, invariants[0]);
    }
    return out;
  }

  /// Returns the flux of f through a side, for every unknown.
  MatrixXd arriving_at(side to, const velocity_function& f) const {
    MatrixXd out(n_, inside_ + 4 * n_);
    for (std::size_t k = 0; k < 4; ++k) {
      out.middleCols(field(k), n_ * n_) = delta_ * flights_.to_side(to, f, invariants[k]);
      out.middleCols(wall(k), n_) = flights_.between(to, sides[k], f, invariants[0]);
    }
    return out;
  }

  double delta_;
  int n_;
  Eigen::Index inside_;
  rectangle_flights flights_;
  Eigen::PartialPivLU<MatrixXd> solver_;
};

}  // namespace

linear_square::linear_square(double delta, int n) {
  const system_of_square square(delta, n);
  const velocity_function momentum = [](double x, double) { return part{x, 0.0}; };
  // ⟨c_n c_x 2 c_x⟩ = 1/(2 √π) leaves the moving top, and ⟨c_n (c² − 2)²⟩ = 1/√π the hot one.
  const double root = 1.0 / std::numbers::inv_sqrtpi;
  drag_ = 1.0 - 2.0 * root * square.flux(side::top, momentum, square.solve(moving), moving);
  const VectorXd heated = square.solve(hot);
  for (const side each : sides)
    heat_[static_cast<std::size_t>(each)] = root * square.flux(each, hot, heated, hot);
}

}  // namespace validation_test
