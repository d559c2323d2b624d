#include <apsis/boundary/tensor_axes.hpp>

#include <apsis/core/errors.hpp>
#include <apsis/core/index.hpp>

#include <algorithm>
#include <span>
#include <utility>

namespace apsis {
namespace {

[[noreturn]] void refuse_velocities() {
  throw input_error(
      "the velocities are not all combinations of numbers in each direction (a wall with any normal "
      "interpolates between them to reflect); use a diffuse wall with accommodation = 1, or velocities in "
      "lines");
}

/// Returns the distinct numbers of a direction, in increasing order.
std::vector<double> numbers_of(std::span<const double> speeds) {
  std::vector<double> numbers(speeds.begin(), speeds.end());
  std::sort(numbers.begin(), numbers.end());
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
  return numbers;
}

}  // namespace

tensor_axes::tensor_axes(const velocity_set& velocities) {
  const auto d = at(velocities.dimensions()), n = at(velocities.size());
  for (std::size_t k = 0; k < d; ++k)
    points_.push_back(numbers_of(velocities.speeds(static_cast<int>(k)).first(n)));
  strides_.assign(d, 1);
  for (std::size_t k = d; k-- > 0;) {
    if (points_[k].size() < 2 || size_ > n) refuse_velocities();
    strides_[k] = size_;
    size_ *= points_[k].size();
  }
  if (d == 0 || size_ != n) refuse_velocities();
  for (std::size_t k = 0; k < d; ++k) add_axis(velocities, k);
}

void tensor_axes::add_axis(const velocity_set& velocities, std::size_t k) {
  constexpr std::size_t bins_per_point = 4;
  const std::vector<double>& v = points_[k];
  const auto speeds = velocities.speeds(static_cast<int>(k));
  const auto weights = velocities.weights();
  bool is_mirrored = true;
  for (std::size_t j = 0; j < size_; ++j) {
    const std::size_t i = j / strides_[k] % v.size(), opposite = v.size() - 1 - i;
    if (speeds[j] != v[i]) refuse_velocities();
    is_mirrored = is_mirrored && v[i] == -v[opposite] &&
                  weights[j] == weights[j - i * strides_[k] + opposite * strides_[k]];
  }
  symmetric_.push_back(is_mirrored);
  const std::size_t count = bins_per_point * v.size();
  const double width = (v.back() - v.front()) / static_cast<double>(count);
  bins made{.per_unit = 1.0 / width, .last = static_cast<double>(count - 1)};
  for (std::size_t i = 0; i + 1 < v.size(); ++i) made.inverse_gaps.push_back(1.0 / (v[i + 1] - v[i]));
  std::size_t below = 0;
  for (std::size_t b = 0; b < count; ++b) {
    while (below + 2 < v.size() && v[below + 1] <= v.front() + width * static_cast<double>(b)) ++below;
    made.first.push_back(static_cast<int>(below));
  }
  bins_.push_back(std::move(made));
}

std::array<std::size_t, 3> tensor_axes::indices_of_line(std::size_t line) const {
  std::array<std::size_t, 3> indices{};
  for (std::size_t k = points_.size() - 1; k-- > 0;) {
    indices[k] = line % points_[k].size();
    line /= points_[k].size();
  }
  return indices;
}

}  // namespace apsis
