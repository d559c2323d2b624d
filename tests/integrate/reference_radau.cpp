#include "integrate/reference.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

namespace reference {
namespace {

using vector2 = Eigen::Matrix<long double, 2, 1>;
using vector6 = Eigen::Matrix<long double, 6, 1>;
using matrix2 = Eigen::Matrix<long double, 2, 2>;
using matrix6 = Eigen::Matrix<long double, 6, 6>;
using matrix3 = Eigen::Matrix<long double, 3, 3>;

constexpr long double local_error = 1e-17L;

struct model {
  long double epsilon;

  vector2 slope(const vector2& u) const {
    return {u[1], (1 + u[0] * u[0]) * (std::sin(u[0]) - u[1]) / epsilon};
  }
  matrix2 jacobian(const vector2& u) const {
    const long double rate = 1 + u[0] * u[0];
    matrix2 j;
    j << 0, 1, (2 * u[0] * (std::sin(u[0]) - u[1]) + rate * std::cos(u[0])) / epsilon, -rate / epsilon;
    return j;
  }
};

/// Returns the coefficients of Radau IIA with three stages (Hairer & Wanner, Solving ODEs II, table IV.5.6).
matrix3 radau_matrix() {
  const long double s = std::sqrt(6.0L);
  matrix3 a;
  a << (88 - 7 * s) / 360, (296 - 169 * s) / 1800, (-2 + 3 * s) / 225,  //
      (296 + 169 * s) / 1800, (88 + 7 * s) / 360, (-2 - 3 * s) / 225,   //
      (16 - s) / 36, (16 + s) / 36, 1.0L / 9;
  return a;
}

/// Takes one step by solving for the increments z_i = u_i − u. Returns false if Newton's method
/// does not converge.
bool radau_step(const model& f, long double h, vector2& u) {
  static const matrix3 a = radau_matrix();
  vector6 z = vector6::Zero();
  for (int iteration = 0; iteration < 30; ++iteration) {
    vector6 residual = z;
    matrix6 m = matrix6::Identity();
    for (int j = 0; j < 3; ++j) {
      const vector2 stage = u + z.segment<2>(2 * j);
      const vector2 slope = f.slope(stage);
      const matrix2 jacobian = f.jacobian(stage);
      for (int i = 0; i < 3; ++i) {
        residual.segment<2>(2 * i) -= h * a(i, j) * slope;
        m.block<2, 2>(2 * i, 2 * j) -= h * a(i, j) * jacobian;
      }
    }
    const vector6 delta = m.partialPivLu().solve(residual);
    z -= delta;
    if (!z.allFinite()) return false;
    if (delta.lpNorm<Eigen::Infinity>() < 1e-18L) {
      u += z.segment<2>(4);
      return true;
    }
  }
  return false;
}

}  // namespace

pair radau(long double epsilon, long double t_end) {
  const model f{epsilon};
  vector2 u(2, 0);
  long double t = 0, h = std::min(1e-3L, epsilon / 100);
  while (t < t_end) {
    h = std::min(h, t_end - t);
    vector2 once = u, twice = u;
    const bool solved = radau_step(f, h, once) && radau_step(f, h / 2, twice) && radau_step(f, h / 2, twice);
    const long double error = solved ? (once - twice).lpNorm<Eigen::Infinity>() / 31 : 1;
    if (error <= local_error) {
      t = t_end - t <= h ? t_end : t + h;
      u = twice;
    }
    h *= std::clamp(0.9L * std::pow(local_error / std::max(error, 1e-24L), 1.0L / 6), 0.2L, 3.0L);
  }
  return {u[0], u[1]};
}

pair limit(long double t_end) {
  const long double u = 2 * std::atan(std::tan(1.0L) * std::exp(t_end));
  return {u, std::sin(u)};
}

}  // namespace reference
