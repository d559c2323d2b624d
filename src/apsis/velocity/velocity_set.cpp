#include <apsis/velocity/velocity_set.hpp>

#include <apsis/core/errors.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include <fmt/format.h>

namespace apsis {

struct velocity_set::numbers {
  std::vector<aligned_vector<double>> speeds;  ///< [k][component]
  std::vector<double> weights;                 ///< [j]
  int sets = 1;
};

namespace {

bool all_finite(std::span<const double> values) {
  return std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); });
}

void check(const std::vector<aligned_vector<double>>& coordinates, const std::vector<double>& weights,
           int sets) {
  if (coordinates.empty() || coordinates.size() > 3)
    throw input_error(fmt::format("{} velocity dimensions (not 1, 2 or 3); give as many rows of coordinates",
                                  coordinates.size()));
  for (const auto& row : coordinates) {
    if (row.size() != weights.size())
      throw input_error(
          fmt::format("{} coordinates for {} weights (a velocity has one of each); give as many", row.size(),
                      weights.size()));
    if (!all_finite(row))
      throw input_error("a velocity is not finite (gas moves along it); give finite coordinates");
  }
  if (!all_finite(weights) || std::any_of(weights.begin(), weights.end(), [](double w) { return w < 0.0; }))
    throw input_error(
        "a weight of a velocity is not a finite number >= 0 (densities are sums with it); change it");
  if (sets < 1)
    throw input_error(fmt::format("{} sets of components (at least one is needed); give more", sets));
}

}  // namespace

velocity_set::velocity_set() : numbers_(std::make_shared<numbers>()) {}

velocity_set::velocity_set(std::vector<aligned_vector<double>> coordinates, std::vector<double> weights,
                           int sets) {
  check(coordinates, weights, sets);
  for (auto& row : coordinates) {
    const std::size_t n = row.size();
    row.resize(n * static_cast<std::size_t>(sets));
    for (std::size_t k = n; k < row.size(); ++k) row[k] = row[k - n];
  }
  numbers_ = std::make_shared<const numbers>(numbers{std::move(coordinates), std::move(weights), sets});
}

int velocity_set::dimensions() const {
  return static_cast<int>(numbers_->speeds.size());
}

int velocity_set::size() const {
  return static_cast<int>(numbers_->weights.size());
}

int velocity_set::sets() const {
  return numbers_->sets;
}

std::span<const double> velocity_set::speeds(int k) const {
  if (k >= dimensions()) return {};
  return numbers_->speeds[static_cast<std::size_t>(k)];
}

std::span<const double> velocity_set::weights() const {
  return numbers_->weights;
}

}  // namespace apsis
