#include <apsis/velocity/velocity_line.hpp>

#include <apsis/core/errors.hpp>
#include <apsis/velocity/widest_gap.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

namespace apsis {
namespace {

void require_enough(int points) {
  if (points < 4)
    throw input_error(fmt::format("{} velocity points (too few for three moments); give at least 4", points));
}

}  // namespace

velocity_line::velocity_line(int points, double max) : max_(max) {
  require_enough(points);
  if (!(max > 0.0) || !std::isfinite(max))
    throw input_error("velocity.max cannot be used (it is not positive and finite); give max > 0");
  spacing_ = 2.0 * max / points;
  // Symmetric by construction: v_{N−1−i} = −v_i exactly, so that even data keep u = 0 to round-off.
  for (int i = 0; i < points; ++i) {
    v_.push_back(0.5 * spacing_ * (2.0 * i + 1.0 - points));
  }
  weights_.assign(v_.size(), spacing_);
  complete();
}

velocity_line::velocity_line(std::vector<double> points, std::vector<double> weights)
    : uniform_(false), spacing_(std::numeric_limits<double>::infinity()) {
  require_enough(static_cast<int>(points.size()));
  if (points.size() != weights.size())
    throw input_error(fmt::format("{} velocities have {} weights (each needs one); give {}", points.size(),
                                  weights.size(), points.size()));
  for (std::size_t j = 0; j < points.size(); ++j) {
    if (!std::isfinite(points[j]) || (j > 0 && !(points[j] > points[j - 1])))
      throw input_error(fmt::format("velocity {} is {:g} (velocities are finite and increase); sort them",
                                    j + 1, points[j]));
    if (!(weights[j] > 0.0) || !std::isfinite(weights[j]))
      throw input_error(
          fmt::format("the weight of velocity {:g} is {:g} (a positive number is needed); change it",
                      points[j], weights[j]));
    if (j > 0) spacing_ = std::min(spacing_, points[j] - points[j - 1]);
  }
  v_.assign(points.begin(), points.end());
  weights_.assign(weights.begin(), weights.end());
  max_ = std::max(std::abs(v_.front()), std::abs(v_.back()));
  complete();
}

void velocity_line::complete() {
  for (const double v : v_) half_square_.push_back(0.5 * v * v);
  set_unit(spacing_);
}

void velocity_line::set_unit(double unit) {
  places_.resize(v_.size());
  const bool exact = uniform_ && unit == spacing_;
  for (std::size_t j = 0; j < v_.size(); ++j)
    places_[j] = exact ? static_cast<double>(j) - 0.5 * (static_cast<double>(v_.size()) - 1.0) : v_[j] / unit;
}

double velocity_line::widest_gap(double from, double to) const {
  return apsis::widest_gap(v_.data(), points(), spacing_, from, to);
}

}  // namespace apsis
