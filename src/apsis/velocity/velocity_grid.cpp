#include <apsis/velocity/velocity_grid.hpp>

#include <apsis/core/errors.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace apsis {

void velocity_grid::check_size(std::span<const int> points) {
  double velocities = 1.0;
  for (const int n : points) velocities *= n;
  const auto d = points.size();
  if (velocities > most_velocities)
    throw input_error(fmt::format(
        "velocity.points = {} are {:.4g} velocities in {} dimension{} (more than {} cannot be numbered); "
        "give at most {}",
        points.front(), velocities, d, d == 1 ? "" : "s", most_velocities,
        static_cast<int>(
            std::floor(std::pow(most_velocities, 1.0 / static_cast<double>(d)) * (1.0 + 1e-12)))));
}

velocity_grid::velocity_grid(int dimensions, int points, double max)
    : velocity_grid([&] {
        if (dimensions < 1 || dimensions > 3)
          throw input_error(
              fmt::format("{} velocity dimensions (not 1, 2 or 3); give 1, 2 or 3", dimensions));
        const std::vector<int> each(static_cast<std::size_t>(dimensions), points);
        check_size(each);
        return std::vector<velocity_line>(each.size(), velocity_line(points, max));
      }()) {}

velocity_grid::velocity_grid(std::vector<velocity_line> lines)
    : lines_(std::move(lines)),
      dimensions_(static_cast<int>(lines_.size())),
      last_component_(dimensions_ - 1) {
  const int d = dimensions();
  if (d < 1 || d > 3)
    throw input_error(fmt::format("{} velocity dimensions (not 1, 2 or 3); give 1, 2 or 3", d));
  std::vector<int> points;
  for (const auto& line : lines_) points.push_back(line.points());
  check_size(points);
  for (const auto& line : lines_) {
    size_ *= line.points();
    uniform_ = uniform_ && line.uniform();
    weight_ *= line.spacing();
  }
  if (!uniform_) weight_ = 1.0;
  unit_ = lines_.front().spacing();
  for (const auto& line : lines_) unit_ = std::min(unit_, line.spacing());
  for (auto& line : lines_) line.set_unit(unit_);
  const auto total = static_cast<std::size_t>(size_);
  std::vector<aligned_vector<double>> components(lines_.size(), aligned_vector<double>(total));
  std::vector<double> weights(total, weight_);
  half_square_.assign(total, 0.0);
  for (std::size_t j = 0; j < total; ++j) {
    std::size_t rest = j;
    for (std::size_t k = lines_.size(); k-- > 0;) {
      const auto n = static_cast<std::size_t>(lines_[k].points());
      const double v = lines_[k].v()[rest % n];
      components[k][j] = v;
      half_square_[j] += 0.5 * v * v;
      if (!uniform_) weights[j] *= lines_[k].weights()[rest % n];
      rest /= n;
    }
  }
  of_lines_.resize(lines_.size() - 1);
  for (std::size_t k = 0; k + 1 < lines_.size(); ++k)
    for (std::size_t j = 0; j < total; j += static_cast<std::size_t>(last_line().points()))
      of_lines_[k].push_back(components[k][j]);
  make_functions_of_lines(weights_of_lines());
  set_ = velocity_set(std::move(components), std::move(weights));
}

velocity_grid::velocity_grid(const velocity_line& axial, const polar_rings& rings, int along)
    : lines_{axial},
      polar_{rings.layout(axial.points())},
      dimensions_(3),
      last_component_(along),
      uniform_(false),
      weight_(1.0),
      unit_(axial.spacing()),
      of_lines_(2) {
  const std::array<int, 3> counts = {axial.points(), polar_.rings, polar_.angles};
  check_size(counts);
  size_ = counts[0] * counts[1] * counts[2];
  std::vector<double> of_points;
  for (int ring = 0; ring < polar_.rings; ++ring)
    for (int angle = 0; angle < polar_.angles; ++angle) {
      of_lines_[0].push_back(rings.speed(ring) * rings.cosine(angle));
      of_lines_[1].push_back(rings.speed(ring) * rings.cosine(angle - polar_.angles / 4));
      of_points.push_back(rings.weight(ring));
    }
  const auto total = static_cast<std::size_t>(size_), n = static_cast<std::size_t>(axial.points());
  std::vector<aligned_vector<double>> components(3, aligned_vector<double>(total));
  std::vector<double> weights(total);
  half_square_.resize(total);
  for (std::size_t j = 0; j < total; ++j) {
    const std::size_t line = j / n, point = j % n;
    const double across[2] = {of_lines_[0][line], of_lines_[1][line]}, v = axial.v()[point];
    components[static_cast<std::size_t>(along)][j] = v;
    for (int k = 0; k < 2; ++k) components[static_cast<std::size_t>(component_across(k))][j] = across[k];
    weights[j] = of_points[line] * axial.weights()[point];
    half_square_[j] = 0.5 * (across[0] * across[0] + across[1] * across[1] + v * v);
  }
  make_functions_of_lines(of_points);
  set_ = velocity_set(std::move(components), std::move(weights));
}

double velocity_grid::max() const {
  double largest = 0.0;
  for (int k = 0; k < dimensions(); ++k) largest = std::max(largest, max(k));
  return largest;
}

double velocity_grid::max(int k) const {
  if (!is_polar()) return line(k).max();
  return k == last_component_ ? last_line().max() : polar_.speeds.back();
}

std::vector<double> velocity_grid::weights_of_lines() const {
  std::vector<double> weights(static_cast<std::size_t>(lines()), 1.0);
  for (std::size_t l = 0; l < weights.size() && !uniform_; ++l) {
    std::size_t rest = l;
    for (std::size_t k = lines_.size() - 1; k-- > 0;) {
      const auto n = static_cast<std::size_t>(lines_[k].points());
      weights[l] *= lines_[k].weights()[rest % n];
      rest /= n;
    }
  }
  return weights;
}

void velocity_grid::make_functions_of_lines(const std::vector<double>& weights_of_lines) {
  const std::size_t outer = of_lines_.size(), count = static_cast<std::size_t>(lines());
  functions_of_lines_.assign((outer + (outer > 0 ? 2 : 1)) * count, 0.0);
  for (std::size_t l = 0; l < count; ++l) {
    const double weight = weights_of_lines[l];
    double half_square = 0.0;
    for (std::size_t k = 0; k < outer; ++k) {
      const double v = of_lines_[k][l];
      functions_of_lines_[(1 + k) * count + l] = weight * v;
      half_square += 0.5 * v * v;
    }
    functions_of_lines_[l] = weight;
    if (outer > 0) functions_of_lines_[(1 + outer) * count + l] = weight * half_square;
  }
}

}  // namespace apsis
