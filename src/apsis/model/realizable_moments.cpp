#include <apsis/model/realizable_moments.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace apsis {
namespace {

/// Rounding of the moments of f ≥ 0 relative to the sums of absolute values: each of n additions and of a few
/// products and divisions rounds once, and two sums are divided.
double rounding_of_sums(const velocity_grid& grid) {
  return 4.0 * (grid.size() + 4.0) * std::numeric_limits<double>::epsilon();
}

/// Below this a moment counts as 0 where there is no mass.
constexpr double vacuum = 1e-300;
/// From here on subnormal terms of the sums lie below the rounding of ρ by a hundred orders.
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

/// Fills the part of direction k; returns ℓ(z).
double place(const velocity_grid& grid, std::size_t k, double z, realizable_moments& to) {
  const double h = 0.5 * (grid.points() - 1.0);
  to.z[k] = std::clamp(z, -h, h);
  const double index = std::clamp(std::round(to.z[k] + h), 0.0, grid.points() - 1.0);
  const double point = index - h;  // exact, and so is the distance where it is small
  const double distance = std::clamp(to.z[k] - point, -0.5, 0.5);
  // Far below the rounding of u; without it no exponent is extreme.
  constexpr double nothing = 1e-100;
  to.nearest[k] = static_cast<int>(index);
  to.offset[k] = std::abs(distance) < nothing ? 0.0 : distance;
  return point * point + 2.0 * point * to.offset[k] + std::abs(to.offset[k]);
}

}  // namespace

std::optional<realizable_moments> find_realizable(const velocity_grid& grid, const double* omega) {
  const int d = grid.dimensions();
  realizable_moments found;
  if (!all_finite(omega, d + 2)) return std::nullopt;
  found.rho = omega[0];
  if (!(found.rho > 0.0)) {
    found.rho = 0.0;
    return is_vacuum(grid, omega) ? std::optional(found) : std::nullopt;
  }
  const double unit = grid.spacing(), h = 0.5 * (grid.points() - 1.0);
  const bool exact = found.rho * std::min({1.0, unit, unit * unit}) > large_enough;
  const double tolerance = exact ? rounding_of_sums(grid) : std::numeric_limits<double>::infinity();
  double least = 0.0;
  for (int k = 0; k < d; ++k) {
    const double z = omega[1 + k] / found.rho / unit;
    if (std::abs(z) - h > tolerance * h || std::isnan(z)) return std::nullopt;
    least += place(grid, static_cast<std::size_t>(k), z, found);
  }
  const double greatest = d * h * h;
  found.square = std::max(2.0 * (omega[1 + d] / found.rho / unit / unit), 0.0);
  found.above_least = found.square - least;
  found.below_greatest = greatest - found.square;
  // ℓ has slopes up to 2h, and the error of z is relative to √square.
  const double margin = tolerance * (1.0 + std::max(found.square, least)) * 2.0;
  if (found.above_least < -margin || found.below_greatest < -tolerance * 2.0 * greatest) return std::nullopt;
  found.above_least = std::clamp(found.above_least, 0.0, greatest - least);
  found.below_greatest = std::clamp(found.below_greatest, 0.0, greatest - least);
  return found;
}

std::string why_unrealizable(const velocity_grid& grid, const double* omega) {
  const int d = grid.dimensions();
  if (!std::isfinite(omega[0])) return "density is not finite";
  if (!all_finite(omega, d + 2)) return "a moment is not finite";
  if (find_realizable(grid, omega)) return "";
  if (!(omega[0] > 0.0)) return fmt::format("density {:.6g} is not positive", omega[0]);
  const fluid_state s = to_fluid_state(omega, d);
  if (!(s.T > 0.0)) return fmt::format("temperature {:.6g} is not positive", s.T);
  const double last = grid.max() - 0.5 * grid.spacing();
  realizable_moments at;
  double least = 0.0, bulk = 0.0;
  for (int k = 0; k < d; ++k) {
    if (std::abs(s.u[k]) > last)
      return fmt::format("bulk velocity {:.6g} lies beyond the last point {:.6g} of the velocity grid",
                         s.u[k], last);
    const double z = s.u[k] / grid.spacing();
    least += place(grid, static_cast<std::size_t>(k), z, at);
    bulk += z * z;
  }
  const double unit = grid.spacing() * grid.spacing() / d;
  const double coldest = (least - bulk) * unit, h = 0.5 * (grid.points() - 1.0);
  if (s.T < coldest)
    return fmt::format(
        "temperature {:.6g} is below {:.6g}, the least that f >= 0 has on a velocity grid of spacing {:.3g} "
        "at this bulk velocity",
        s.T, coldest, grid.spacing());
  return fmt::format(
      "temperature {:.6g} is above {:.6g}, the largest that f >= 0 has on the velocity grid at this bulk "
      "velocity",
      s.T, (d * h * h - bulk) * unit);
}

}  // namespace apsis
