// Velocities, rows and fluxes at a wall with any normal.
#pragma once

#include <apsis/core/index.hpp>
#include <apsis/velocity/velocity_grid.hpp>
#include <apsis/velocity/velocity_line_registry.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <vector>

namespace oblique_rows {

using apsis::at;
using apsis::velocity_set;
using vector = std::array<double, 3>;

inline velocity_set grid_of(int d, const std::string& kind, int points, double max, int sets) {
  const apsis::velocity_grid grid(
      std::vector<apsis::velocity_line>(at(d), apsis::find_velocity_line(kind).make(points, max)));
  std::vector<apsis::aligned_vector<double>> coordinates;
  for (int k = 0; k < d; ++k)
    coordinates.emplace_back(grid.set().speeds(k).begin(), grid.set().speeds(k).end());
  return {coordinates, {grid.set().weights().begin(), grid.set().weights().end()}, sets};
}

inline vector velocity_of(const velocity_set& set, std::size_t j) {
  vector v{};
  for (int k = 0; k < set.dimensions(); ++k) v[at(k)] = set.speeds(k)[j];
  return v;
}

inline double product(const vector& a, const vector& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

inline vector random_normal(int d, std::mt19937& generator) {
  std::normal_distribution<double> number;
  vector n{};
  for (int k = 0; k < d; ++k) n[at(k)] = number(generator);
  const double size = std::sqrt(product(n, n));
  for (double& one : n) one /= size;
  return n;
}

inline std::vector<double> inward_of(const velocity_set& set, const vector& normal) {
  std::vector<double> inward;
  for (std::size_t j = 0; j < at(set.components()); ++j)
    inward.push_back(product(velocity_of(set, j), normal));
  return inward;
}

/// Fluxes over half of the velocities: mass, tangential momentum, energy of g and of h, and the sizes of
/// these sums.
struct fluxes {
  std::array<long double, 6> sum{}, size{};
};

inline fluxes fluxes_of(const velocity_set& set, const vector& normal, const std::vector<double>& inward,
                        double sign, const std::vector<double>& f) {
  fluxes all;
  const std::size_t n = at(set.size());
  for (std::size_t j = 0; j < n; ++j) {
    if (!(sign * inward[j] > 0.0)) continue;
    const vector v = velocity_of(set, j);
    const long double speed = std::abs(inward[j]), flux = set.weights()[j] * speed * f[j];
    const long double of_h = set.sets() > 1 ? set.weights()[j] * speed * f[n + j] : 0.0L;
    std::array<long double, 6> one = {flux, 0, 0, 0, 0.5L * flux * product(v, v), 0.5L * of_h}, size = one;
    for (std::size_t k = 0; k < 3; ++k) {
      one[1 + k] = flux * (v[k] - inward[j] * normal[k]);
      size[1 + k] = std::abs(flux) * std::sqrt(product(v, v));
    }
    for (std::size_t k = 0; k < one.size(); ++k) {
      all.sum[k] += one[k];
      all.size[k] += std::abs(size[k]);
    }
  }
  return all;
}

/// Returns the largest difference between arriving and leaving fluxes, relative to their sizes. With
/// `mass_alone` it compares only the mass.
inline double difference(const fluxes& a, const fluxes& b, bool mass_alone) {
  double most = 0.0;
  for (std::size_t k = 0; k < (mass_alone ? 1 : a.sum.size()); ++k)
    if (a.size[k] > 0.0L)
      most = std::max(most, static_cast<double>(std::abs(a.sum[k] - b.sum[k]) / a.size[k]));
  return most;
}

enum class row_kind { positive, decades, few };

/// Returns positive numbers, or numbers over ten decades with zeros and subnormal numbers, or mostly zeros.
inline std::vector<double> random_row(row_kind kind, std::size_t count, std::mt19937& generator) {
  std::uniform_real_distribution<double> share(0.0, 1.0);
  std::vector<double> f(count);
  for (double& one : f) {
    const double choice = share(generator), number = share(generator);
    if (kind == row_kind::positive) one = number;
    if (kind == row_kind::decades)
      one = choice < 0.2 ? 0.0 : choice < 0.3 ? number * 1e-310 : std::pow(10.0, -10.0 * number);
    if (kind == row_kind::few) one = choice < 0.01 ? std::pow(10.0, -10.0 * number) : 0.0;
  }
  return f;
}

inline std::vector<double> row_of(const velocity_set& set, const std::function<double(const vector&)>& f) {
  std::vector<double> row;
  for (std::size_t j = 0; j < at(set.components()); ++j)
    row.push_back((j < at(set.size()) ? 1.0 : 1.7) * f(velocity_of(set, j)));
  return row;
}

inline double maxwellian(const vector& v, const vector& u, double T) {
  const vector c = {v[0] - u[0], v[1] - u[1], v[2] - u[2]};
  return std::exp(-0.5 * product(c, c) / T);
}

}  // namespace oblique_rows
