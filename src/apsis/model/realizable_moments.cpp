#include <apsis/model/realizable_moments.hpp>

#include <apsis/model/polar_maxwellian.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace apsis {
namespace {

/// Returns a bound on the rounding of the moments of f ≥ 0, relative to the sums of absolute values. Each of
/// n additions, and of a few products and divisions, rounds once. Two sums are divided.
double rounding_of_sums(const velocity_grid& grid) {
  return 4.0 * (grid.size() + 4.0) * std::numeric_limits<double>::epsilon();
}

/// Moments of a vacuum up to this size count as 0.
constexpr double vacuum = 1e-300;
/// For larger moments, subnormal terms of the sums lie far below the rounding of ρ.
constexpr double large_enough = 1e-200;

bool all_finite(const double* omega, int count) {
  return std::all_of(omega, omega + count, [](double x) { return std::isfinite(x); });
}

bool is_vacuum(const velocity_grid& grid, const double* omega) {
  const double v = std::max(1.0, grid.max());
  if (!(std::abs(omega[0]) <= vacuum) || !(std::abs(omega[1 + grid.dimensions()]) <= vacuum * v * v))
    return false;
  for (int k = 0; k < grid.dimensions(); ++k)
    if (!(std::abs(omega[1 + k]) <= vacuum * v)) return false;
  return true;
}

/// Least and greatest mean of v_k²/Δv² with the mean z.
struct bounds {
  double least, greatest;
};

/// Returns the index of the place nearest to z.
int nearest_place(const velocity_line& line, double z) {
  const auto& places = line.places();
  const auto after = std::lower_bound(places.begin(), places.end(), z);
  if (after == places.begin()) return 0;
  if (after == places.end()) return line.points() - 1;
  const int right = static_cast<int>(after - places.begin());
  return *after - z <= z - *(after - 1) ? right : right - 1;
}

/// Sets the members of `to` for direction k and returns the bounds.
bounds place(const velocity_grid& grid, std::size_t k, double z, realizable_moments& to) {
  const velocity_line& line = grid.line(static_cast<int>(k));
  const auto& places = line.places();
  const double first = places.front(), last = places.back();
  to.z[k] = std::clamp(z, first, last);
  const int index = nearest_place(line, to.z[k]);
  const double point = places[static_cast<std::size_t>(index)];
  const double distance = to.z[k] - point;  // exact if it is small
  // Far below the rounding of u. Treating it as 0 avoids extreme exponents.
  constexpr double nothing = 1e-100;
  to.nearest[k] = index;
  to.offset[k] = std::abs(distance) < nothing ? 0.0 : distance;
  const double offset = to.offset[k];
  const int other = std::clamp(index + (offset > 0.0 ? 1 : -1), 0, line.points() - 1);
  const double gap = std::abs(places[static_cast<std::size_t>(other)] - point);
  return {point * point + 2.0 * point * offset + std::abs(offset) * gap,
          to.z[k] * (first + last) - first * last};
}

}  // namespace

std::optional<realizable_moments> compute_realizable(const velocity_grid& grid, const double* omega) {
  const int d = grid.dimensions();
  realizable_moments found;
  if (!all_finite(omega, d + 2)) return std::nullopt;
  found.rho = omega[0];
  if (!(found.rho > 0.0)) {
    found.rho = 0.0;
    return is_vacuum(grid, omega) ? std::optional(found) : std::nullopt;
  }
  const double unit = grid.unit();
  const bool exact = found.rho * std::min({1.0, unit, unit * unit}) > large_enough;
  const double tolerance = exact ? rounding_of_sums(grid) : std::numeric_limits<double>::infinity();
  double least = 0.0, greatest = 0.0;
  for (int k = 0; k < d; ++k) {
    const double z = omega[1 + k] / found.rho / unit;
    const auto& places = grid.line(k).places();
    const double margin = tolerance * std::max(std::abs(places.front()), std::abs(places.back()));
    if (z - places.back() > margin || places.front() - z > margin || std::isnan(z)) return std::nullopt;
    const bounds of = place(grid, static_cast<std::size_t>(k), z, found);
    least += of.least;
    greatest += of.greatest;
  }
  found.square = std::max(2.0 * (omega[1 + d] / found.rho / unit / unit), 0.0);
  found.above_least = found.square - least;
  found.below_greatest = greatest - found.square;
  // The slopes of ℓ are at most twice the ends, and the error of z is relative to √square.
  const double margin = tolerance * (1.0 + std::max(found.square, least)) * 2.0;
  if (found.above_least < -margin || found.below_greatest < -tolerance * 2.0 * greatest) return std::nullopt;
  found.above_least = std::clamp(found.above_least, 0.0, greatest - least);
  found.below_greatest = std::clamp(found.below_greatest, 0.0, greatest - least);
  return found;
}

std::string why_unrealizable(const velocity_grid& grid, const double* omega) {
  if (grid.is_polar()) return why_unrealizable_on_rings(grid, omega);
  const int d = grid.dimensions();
  if (!std::isfinite(omega[0])) return "density is not finite";
  if (!all_finite(omega, d + 2)) return "a moment is not finite";
  if (compute_realizable(grid, omega)) return "";
  if (!(omega[0] > 0.0)) return fmt::format("density {:.6g} is not positive", omega[0]);
  const fluid_state s = to_fluid_state(omega, d);
  if (!(s.T > 0.0)) return fmt::format("temperature {:.6g} is not positive", s.T);
  realizable_moments at;
  double least = 0.0, greatest = 0.0, bulk = 0.0;
  for (int k = 0; k < d; ++k) {
    const auto& v = grid.line(k).v();
    const double last = s.u[k] > 0.0 ? v.back() : v.front();
    if (s.u[k] > v.back() || s.u[k] < v.front())
      return fmt::format("bulk velocity {:.6g} lies beyond the last point {:.6g} of the velocity grid",
                         s.u[k], std::abs(last));
    const double z = s.u[k] / grid.unit();
    const bounds of = place(grid, static_cast<std::size_t>(k), z, at);
    least += of.least;
    greatest += of.greatest;
    bulk += z * z;
  }
  const double unit = grid.unit() * grid.unit() / d;
  const double coldest = (least - bulk) * unit;
  if (s.T < coldest)
    return fmt::format(
        "temperature {:.6g} is below {:.6g}, the least that f >= 0 has on a velocity grid of spacing {:.3g} "
        "at this bulk velocity",
        s.T, coldest, grid.unit());
  return fmt::format(
      "temperature {:.6g} is above {:.6g}, the largest that f >= 0 has on the velocity grid at this bulk "
      "velocity",
      s.T, (greatest - bulk) * unit);
}

}  // namespace apsis
