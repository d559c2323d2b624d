#include <apsis/model/velocity_rays.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

namespace apsis {
namespace {

using std::numbers::pi;

constexpr int angles = 256;  // angles of a quadrant at which the error is evaluated

/// Momentum of one velocity, or of all velocities of some directions.
struct momentum {
  double x = 0.0, y = 0.0;
};

/// Returns the sums of one quadrant. Entry i sums over the directions between angles i − 1 and i.
std::vector<momentum> sums_of_sectors(const velocity_line& first, const velocity_line& second, double T,
                                      double sign_x, double sign_y) {
  std::vector<momentum> sums(angles + 1);
  for (int i = 0; i < first.points(); ++i)
    for (int j = 0; j < second.points(); ++j) {
      const auto a = static_cast<std::size_t>(i), b = static_cast<std::size_t>(j);
      const double x = sign_x * first.v()[a], y = sign_y * second.v()[b];
      if (!(x >= 0.0 && y >= 0.0)) continue;
      const double weight = first.weights()[a] * second.weights()[b] * std::exp(-0.5 * (x * x + y * y) / T) /
                            (2.0 * pi * T * std::sqrt(T));
      // Angle k lies at (k + ½) π/(2 angles).
      const double place = std::ceil(std::atan2(y, x) * (2.0 * angles / pi) - 0.5);
      momentum& sum = sums[static_cast<std::size_t>(std::clamp(place, 0.0, double(angles)))];
      sum.x += weight * x;
      sum.y += weight * y;
    }
  return sums;
}

double mean_square(const std::vector<momentum>& sums) {
  const double exact = 0.5 / std::sqrt(2.0 * pi);  // ∫ c² exp(−c²/2)/(2π) dc
  momentum inside;
  double total = 0.0;
  for (int k = 0; k < angles; ++k) {
    inside.x += sums[static_cast<std::size_t>(k)].x;
    inside.y += sums[static_cast<std::size_t>(k)].y;
    const double angle = (k + 0.5) * pi / (2.0 * angles);
    const double x = inside.x - exact * std::sin(angle), y = inside.y - exact * (1.0 - std::cos(angle));
    total += x * x + y * y;
  }
  return total / angles;
}

}  // namespace

double ray_error(const velocity_line& first, const velocity_line& second, double T) {
  double total = 0.0;
  for (const double sign_x : {-1.0, 1.0})
    for (const double sign_y : {-1.0, 1.0})
      total += mean_square(sums_of_sectors(first, second, T, sign_x, sign_y));
  return std::sqrt(total / 4.0);
}

}  // namespace apsis
