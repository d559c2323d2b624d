#include "bgk.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

// bench/CMakeLists.txt compiles this file a second time, for this processor. The function then has
// another name.
#ifndef APSIS_MAKE_BGK
#define APSIS_MAKE_BGK make_bgk
#endif

namespace apsis::bench::plain {
namespace {

double square(double x) {
  return x * x;
}

/// Edge values Σ_k ω_k q_k of WENO5-Z, with ω_k ∝ (linear weight)(1 + (τ/(β_k + δ))²).
struct weno_z {
  double g0, g1, g2;

  weno_z(double a, double b, double c, double d, double e) {
    const double beta0 = 13.0 / 12.0 * square(a - 2.0 * b + c) + 0.25 * square(a - 4.0 * b + 3.0 * c);
    const double beta1 = 13.0 / 12.0 * square(b - 2.0 * c + d) + 0.25 * square(b - d);
    const double beta2 = 13.0 / 12.0 * square(c - 2.0 * d + e) + 0.25 * square(3.0 * c - 4.0 * d + e);
    const double delta = 1e-6 * c * c + 1e-200;
    const double tau = std::abs(beta0 - beta2);
    g0 = 1.0 + square(tau / (beta0 + delta));
    g1 = 1.0 + square(tau / (beta1 + delta));
    g2 = 1.0 + square(tau / (beta2 + delta));
  }

  /// Returns the value at an edge of the cell c. `far`, `middle` and `near` are the factors of the stencils,
  /// ordered towards the edge; their linear weights are (1, 6, 3)/10.
  static double edge(double far, double middle, double near, double a, double b, double c, double d,
                     double e) {
    const double w0 = 0.1 * far, w1 = 0.6 * middle, w2 = 0.3 * near;
    const double q0 = 2.0 * a - 7.0 * b + 11.0 * c;
    const double q1 = -b + 5.0 * c + 2.0 * d;
    const double q2 = 2.0 * c + 5.0 * d - e;
    return (w0 * q0 + w1 * q1 + w2 * q2) / (6.0 * (w0 + w1 + w2));
  }
};

/// Returns the admissible fraction of the deviation from the average c, if `lowest` is the smallest value
/// (Zhang, Shu). The floor prevents negative values from rounding errors of the update.
double scaling(double c, double lowest) {
  const double floor = 1e-13 * c;
  return lowest < floor ? std::max((c - floor) / (c - lowest), 0.0) : 1.0;
}

constexpr double gauss_weight[3] = {5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0};

class loops final : public bgk {
 public:
  loops(mesh space, method scheme);

  void step(double dt, std::vector<double>& f) override;

 private:
  std::size_t at(int cell, int j) const {
    return static_cast<std::size_t>(cell) * static_cast<std::size_t>(velocities_) +
           static_cast<std::size_t>(j);
  }
  const double* neighbour(const std::vector<double>& f, int cell) const;

  /// Computes left_ and right_, the edge values of every cell.
  void reconstruct(const std::vector<double>& f);
  void limit(const std::vector<double>& f);
  void transport(const std::vector<double>& f, std::vector<double>& out);
  void collide(double a, double b, std::vector<double>& f);
  void gauss_values(const std::vector<double>& f, int cell);
  void maxwellian(const std::vector<double>& f);
  void sum_stage(int i, double dt, const std::vector<double>& f, std::vector<double>& u) const;

  mesh mesh_;
  method method_;
  int velocities_;
  double dv_;
  std::vector<std::vector<double>> stages_, transports_;
  std::vector<bool> transported_;  ///< whether T of the stage enters a later one
  std::vector<double> left_, right_, result_, maxwellian_;
  std::vector<double> gauss_[3];
};

loops::loops(mesh space, method scheme)
    : mesh_(std::move(space)),
      method_(std::move(scheme)),
      velocities_(static_cast<int>(mesh_.v.size())),
      dv_(mesh_.v[1] - mesh_.v[0]) {
  const auto s = static_cast<std::size_t>(method_.stages);
  const auto numbers = static_cast<std::size_t>(mesh_.cells) * mesh_.v.size();
  stages_.assign(s, std::vector<double>(numbers));
  transports_.assign(s, std::vector<double>(numbers));
  for (std::size_t j = 0; j < s; ++j) {
    bool wanted = false;
    for (std::size_t i = j + 1; i < s; ++i) wanted = wanted || method_.W[i * s + j] != 0.0;
    transported_.push_back(wanted);
  }
  for (auto* numbers_of_cells : {&left_, &right_, &result_}) numbers_of_cells->resize(numbers);
  for (auto& row : gauss_) row.resize(mesh_.v.size());
  maxwellian_.resize(mesh_.v.size());
}

void loops::step(double dt, std::vector<double>& f) {
  for (int i = 0; i < method_.stages; ++i) {
    const auto k = static_cast<std::size_t>(i);
    sum_stage(i, dt, f, stages_[k]);
    if (method_.d[k] != 0.0 || method_.ddot[k] != 0.0)
      collide(dt * method_.d[k], dt * dt * method_.ddot[k], stages_[k]);
    if (transported_[k]) transport(stages_[k], transports_[k]);
  }
  std::swap(f, stages_.back());
}

void loops::sum_stage(int i, double dt, const std::vector<double>& f, std::vector<double>& u) const {
  const auto s = static_cast<std::size_t>(method_.stages);
  const auto entry = [s](const std::vector<double>& m, int row, int column) {
    return m[static_cast<std::size_t>(row) * s + static_cast<std::size_t>(column)];
  };
  double initial = 1.0;
  for (int j = 0; j < i; ++j) initial -= entry(method_.P, i, j) + entry(method_.W, i, j);
  for (std::size_t n = 0; n < f.size(); ++n) u[n] = initial * f[n];
  for (int j = 0; j < i; ++j) {
    const double p = entry(method_.P, i, j), w = entry(method_.W, i, j);
    const auto& uj = stages_[static_cast<std::size_t>(j)];
    const auto& tj = transports_[static_cast<std::size_t>(j)];
    if (w != 0.0) {
      const double h = w * dt / method_.r;
      for (std::size_t n = 0; n < f.size(); ++n) u[n] += (p + w) * uj[n] + h * tj[n];
    } else if (p != 0.0) {
      for (std::size_t n = 0; n < f.size(); ++n) u[n] += p * uj[n];
    }
  }
}

const double* loops::neighbour(const std::vector<double>& f, int cell) const {
  return f.data() + at((cell + mesh_.cells) % mesh_.cells, 0);
}

void loops::reconstruct(const std::vector<double>& f) {
  for (int i = 0; i < mesh_.cells; ++i) {
    const double *a = neighbour(f, i - 2), *b = neighbour(f, i - 1), *c = neighbour(f, i),
                 *d = neighbour(f, i + 1), *e = neighbour(f, i + 2);
    double *left = left_.data() + at(i, 0), *right = right_.data() + at(i, 0);
    for (int j = 0; j < velocities_; ++j) {
      const weno_z g(a[j], b[j], c[j], d[j], e[j]);
      right[j] = weno_z::edge(g.g0, g.g1, g.g2, a[j], b[j], c[j], d[j], e[j]);
      left[j] = weno_z::edge(g.g2, g.g1, g.g0, e[j], d[j], c[j], b[j], a[j]);
    }
  }
}

void loops::limit(const std::vector<double>& f) {
  // By four-point Gauss–Lobatto quadrature, the average is (l + r)/12 + (10/12) times an interior value.
  for (std::size_t n = 0; n < f.size(); ++n) {
    const double c = f[n], l = left_[n], r = right_[n];
    const double between = (c - (l + r) * (1.0 / 12.0)) * 1.2;
    const double theta = scaling(c, std::min(std::min(l, r), between));
    left_[n] = c + theta * (l - c);
    right_[n] = c + theta * (r - c);
  }
}

void loops::transport(const std::vector<double>& f, std::vector<double>& out) {
  reconstruct(f);
  limit(f);
  const double per_length = 1.0 / mesh_.dx;
  for (int i = 0; i < mesh_.cells; ++i) {
    const double *before = neighbour(right_, i - 1), *after = neighbour(left_, i + 1);
    const double *left = left_.data() + at(i, 0), *right = right_.data() + at(i, 0);
    double* t = out.data() + at(i, 0);
    for (int j = 0; j < velocities_; ++j) {
      const double v = mesh_.v[static_cast<std::size_t>(j)];
      const double in = v > 0.0 ? v * before[j] : v * left[j];
      const double leaving = v > 0.0 ? v * right[j] : v * after[j];
      t[j] = (in - leaving) * per_length;
    }
  }
}

void loops::gauss_values(const std::vector<double>& f, int cell) {
  const double xi_gauss = std::sqrt(0.6) / 2.0, xi_lobatto = 0.5 / std::sqrt(5.0);
  const double *m = neighbour(f, cell - 1), *average = neighbour(f, cell), *p = neighbour(f, cell + 1);
  const double *left = left_.data() + at(cell, 0), *right = right_.data() + at(cell, 0);
  for (int j = 0; j < velocities_; ++j) {
    const double c = average[j], l = left[j], r = right[j];
    // This quartic has the given edge values, and the averages over the three cells, in differences from c.
    const double edges = (l - c) + (r - c), slope = r - l, neighbours = (m[j] - c) + (p[j] - c),
                 rise = p[j] - m[j];
    const double d0 = -9.0 / 32.0 * edges + neighbours * (1.0 / 192.0);
    const double d1 = 1.25 * slope - 0.125 * rise;
    const double d2 = 3.75 * edges - 0.125 * neighbours;
    const double d3 = 0.5 * rise - slope;
    const double d4 = -2.5 * edges + 5.0 / 12.0 * neighbours;
    const auto quartic = [&](double x) { return d0 + x * (d1 + x * (d2 + x * (d3 + x * d4))); };
    const double g0 = quartic(-xi_gauss), g2 = quartic(xi_gauss);
    const double inner = std::min(quartic(-xi_lobatto), quartic(xi_lobatto));
    const double lowest = std::min({l - c, r - c, inner, g0, d0, g2});
    const double theta = scaling(c, c + lowest);
    const auto k = static_cast<std::size_t>(j);
    gauss_[0][k] = c + theta * g0;
    gauss_[1][k] = c + theta * d0;
    gauss_[2][k] = c + theta * g2;
  }
}

void loops::maxwellian(const std::vector<double>& f) {
  double mass = 0.0, momentum = 0.0, energy = 0.0;
  for (std::size_t j = 0; j < f.size(); ++j) {
    const double v = mesh_.v[j];
    mass += f[j];
    momentum += v * f[j];
    energy += 0.5 * v * v * f[j];
  }
  const double rho = dv_ * mass, u = momentum / mass, T = 2.0 * energy / mass - u * u;
  const double factor = rho / std::sqrt(2.0 * std::numbers::pi * T), exponent = -0.5 / T;
  for (std::size_t j = 0; j < f.size(); ++j)
    maxwellian_[j] = factor * std::exp(exponent * square(mesh_.v[j] - u));
}

void loops::collide(double a, double b, std::vector<double>& f) {
  reconstruct(f);
  for (int i = 0; i < mesh_.cells; ++i) {
    gauss_values(f, i);
    double* average = result_.data() + at(i, 0);
    std::fill_n(average, velocities_, 0.0);
    for (std::size_t q = 0; q < 3; ++q) {
      maxwellian(gauss_[q]);
      const double rate = 1.0 / mesh_.epsilon[static_cast<std::size_t>(i) * 3 + q];
      const double mu = a * rate - b * rate * rate;
      const double stay = gauss_weight[q] / (1.0 + mu), relax = gauss_weight[q] * mu / (1.0 + mu);
      for (int j = 0; j < velocities_; ++j) {
        const auto k = static_cast<std::size_t>(j);
        average[j] += stay * gauss_[q][k] + relax * maxwellian_[k];
      }
    }
  }
  std::swap(f, result_);
}

}  // namespace

std::unique_ptr<bgk> APSIS_MAKE_BGK(bgk::mesh space, method scheme) {
  return std::make_unique<loops>(std::move(space), std::move(scheme));
}

}  // namespace apsis::bench::plain
