#include <apsis/boundary/half_range_gaussian.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace apsis {
namespace {

constexpr double lowest_drift = -4.0, drift_step = 0.25;
constexpr std::size_t drifts = 113;

/// The ratios I_3/I_1 and (I_1/I_2)² of a drift.
struct drift_ratios {
  double cubic = 0.0, linear = 0.0;

  double of_square(int d) const { return (d - 1 + cubic) * linear; }
};

drift_ratios ratios_of(double a) {
  const double share = 0.5 * std::erfc(-a / std::numbers::sqrt2),
               density = std::exp(-0.5 * a * a) / std::sqrt(2.0 * std::numbers::pi),
               first = density + a * share, second = (1.0 + a * a) * share + a * density,
               third = a * (a * a + 3.0) * share + (a * a + 2.0) * density;
  return {third / first, first * first / (second * second)};
}

}  // namespace

std::optional<half_range_gaussian> gaussian_of_fluxes(double z, double square, int dimensions) {
  static const auto table = [] {
    std::array<drift_ratios, drifts> made;
    for (std::size_t k = 0; k < drifts; ++k)
      made[k] = ratios_of(lowest_drift + drift_step * static_cast<double>(k));
    return made;
  }();
  const double wanted = square / (z * z);
  // The ratio square/z² decreases with a.
  if (!(wanted < table.front().of_square(dimensions) && wanted > table.back().of_square(dimensions)))
    return std::nullopt;
  std::size_t below = 0, above = drifts - 1;
  while (above - below > 1) {
    const std::size_t middle = (below + above) / 2;
    (table[middle].of_square(dimensions) > wanted ? below : above) = middle;
  }
  const double first = table[below].of_square(dimensions), second = table[above].of_square(dimensions),
               share = (first - wanted) / (first - second);
  const double cubic = table[below].cubic + share * (table[above].cubic - table[below].cubic);
  return half_range_gaussian{lowest_drift + drift_step * (static_cast<double>(below) + share),
                             square / (dimensions - 1 + cubic)};
}

}  // namespace apsis
