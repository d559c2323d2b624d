#pragma once

#include <apsis/method/method.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <numbers>
#include <vector>

/// The limit ε → 0 of a gas on a periodic mesh in the plane. Plain loops compute it independently of the
/// operators and the stepper of the library. ω = (ρ, ρu_x, ρu_y, 𝓔) of every cell satisfies
///   ω_i = r_i ω^n + Σ_j p_ij ω_j + w_ij (ω_j + (Δt/r) L(ω_j)),  L(ω) = −ℛ Σ_k ∂_k (v_k M[ω]).
/// ∂_k is the fifth-order WENO difference with Z weights of the upwind flux of every velocity.
class plane_euler_limit {
 public:
  using moments = std::array<double, 4>;
  struct setting {
    int nx, ny;              ///< cells
    double hx, hy;           ///< spacings
    double v_max;            ///< velocities on [−v_max, v_max] along both axes
    int points;              ///< velocities per axis
    int degrees_of_freedom;  ///< 2, or more: h = (degrees_of_freedom − 2) T g
  };

  plane_euler_limit(const setting& of, const std::function<moments(double, double)>& initial) : s(of) {
    for (int i = 0; i < s.nx; ++i)
      for (int j = 0; j < s.ny; ++j) omega.push_back(initial((i + 0.5) * s.hx, (j + 0.5) * s.hy));
  }

  void step(const apsis::shu_osher_form<double>& m, double dt) {
    std::vector<std::vector<moments>> stages, slopes;
    for (std::size_t i = 0; i < m.stages(); ++i) {
      std::vector<moments> stage(omega.size());
      double left = 1.0;
      for (std::size_t j = 0; j < i; ++j) left -= m.P(i, j) + m.W(i, j);
      for (std::size_t c = 0; c < omega.size(); ++c)
        for (std::size_t k = 0; k < 4; ++k) {
          stage[c][k] = left * omega[c][k];
          for (std::size_t j = 0; j < i; ++j)
            stage[c][k] +=
                m.P(i, j) * stages[j][c][k] + m.W(i, j) * (stages[j][c][k] + dt / m.r * slopes[j][c][k]);
        }
      slopes.push_back(slope(stage));
      stages.push_back(std::move(stage));
    }
    omega = stages.back();
  }

  std::vector<moments> omega;  ///< [x][y]

 private:
  double velocity(int j) const { return s.v_max * ((2.0 * j + 1.0) / s.points - 1.0); }
  double weight() const { return 4.0 * s.v_max * s.v_max / (s.points * s.points); }
  int degrees_of_h() const { return s.degrees_of_freedom - 2; }

  double temperature(const moments& w) const {
    return (2.0 * w[3] / w[0] - (w[1] * w[1] + w[2] * w[2]) / (w[0] * w[0])) / s.degrees_of_freedom;
  }
  double maxwellian(const moments& w, double vx, double vy) const {
    const double T = temperature(w), a = vx - w[1] / w[0], b = vy - w[2] / w[0];
    return w[0] / (2.0 * std::numbers::pi * T) * std::exp(-(a * a + b * b) / (2.0 * T));
  }

  /// Returns the value at the edge between c and d (Jiang & Shu, JCP 126, 1996). The weights are those of
  /// Borges et al., JCP 227, 2008, with power 2. δ is relative to the value of the cell.
  static double edge(double a, double b, double c, double d, double e) {
    const double q0 = (2.0 * a - 7.0 * b + 11.0 * c) / 6.0, q1 = (-b + 5.0 * c + 2.0 * d) / 6.0,
                 q2 = (2.0 * c + 5.0 * d - e) / 6.0;
    const auto square = [](double x) { return x * x; };
    const double b0 = 13.0 / 12.0 * square(a - 2.0 * b + c) + 0.25 * square(a - 4.0 * b + 3.0 * c),
                 b1 = 13.0 / 12.0 * square(b - 2.0 * c + d) + 0.25 * square(b - d),
                 b2 = 13.0 / 12.0 * square(c - 2.0 * d + e) + 0.25 * square(3.0 * c - 4.0 * d + e);
    const double tau = std::abs(b0 - b2), delta = 1e-6 * c * c + 1e-200;
    const double a0 = 0.1 * (1.0 + square(tau / (b0 + delta))), a1 = 0.6 * (1.0 + square(tau / (b1 + delta))),
                 a2 = 0.3 * (1.0 + square(tau / (b2 + delta)));
    return (a0 * q0 + a1 * q1 + a2 * q2) / (a0 + a1 + a2);
  }

  /// Returns the upwind value between cells 0 and 1, from values at cells −2 … 3.
  template <class Values>
  static double upwind(const Values& f, double v) {
    return v > 0.0 ? edge(f(-2), f(-1), f(0), f(1), f(2)) : edge(f(3), f(2), f(1), f(0), f(-1));
  }

  std::vector<moments> slope(const std::vector<moments>& w) const {
    std::vector<moments> sum(w.size(), moments{});
    std::vector<double> f(w.size());
    for (int a = 0; a < s.points; ++a)
      for (int b = 0; b < s.points; ++b) {
        const double vx = velocity(a), vy = velocity(b), half = 0.5 * (vx * vx + vy * vy);
        for (std::size_t c = 0; c < w.size(); ++c) f[c] = maxwellian(w[c], vx, vy);
        add(f, vx, vy, {1.0, vx, vy, half}, sum);
        if (degrees_of_h() == 0) continue;
        for (std::size_t c = 0; c < w.size(); ++c) f[c] *= degrees_of_h() * temperature(w[c]);
        add(f, vx, vy, {0.0, 0.0, 0.0, 0.5}, sum);
      }
    return sum;
  }

  /// Adds the term of one velocity: sum ← sum − Δv² φ (v·∇f).
  void add(const std::vector<double>& f, double vx, double vy, const moments& phi,
           std::vector<moments>& sum) const {
    const auto at = [&](int i, int j) {
      return f[static_cast<std::size_t>((i + s.nx) % s.nx * s.ny + (j + s.ny) % s.ny)];
    };
    for (int i = 0; i < s.nx; ++i)
      for (int j = 0; j < s.ny; ++j) {
        const auto along_x = [&](int first) {
          return upwind([&](int k) { return at(i + first + k, j); }, vx);
        };
        const auto along_y = [&](int first) {
          return upwind([&](int k) { return at(i, j + first + k); }, vy);
        };
        const double change = vx * (along_x(0) - along_x(-1)) / s.hx + vy * (along_y(0) - along_y(-1)) / s.hy;
        for (std::size_t k = 0; k < 4; ++k)
          sum[static_cast<std::size_t>(i * s.ny + j)][k] -= weight() * phi[k] * change;
      }
  }

  setting s;
};
