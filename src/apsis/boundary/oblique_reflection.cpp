#include <apsis/boundary/oblique_reflection.hpp>

#include <apsis/boundary/half_range_gaussian.hpp>
#include <apsis/boundary/mirrored_interpolation.hpp>
#include <apsis/core/errors.hpp>
#include <apsis/core/index.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>

namespace apsis {

/// The Maxwellian M of the arriving gas.
struct oblique_reflection::reference {
  exponential_family family;
  exponential_family::vector multipliers{};  ///< λ without the constant
  exponential_family::vector wanted{};       ///< fluxes of the arriving gas
  int passes = 0;
};

namespace {

using multipliers_of_wall = exponential_family::vector;

/// Larger exponents would leave no room for the distribution in the range of doubles.
constexpr double most_exponent = 600.0;

/// Returns the unit vectors of the constant, of the tangential directions and of the energy.
boost::container::small_vector<multipliers_of_wall, 5> basis_of_wall(const std::array<double, 3>& normal,
                                                                     std::size_t d) {
  boost::container::small_vector<multipliers_of_wall, 5> basis(1);
  basis[0][0] = 1.0;
  std::size_t largest = 0;
  for (std::size_t k = 1; k < d; ++k)
    if (std::abs(normal[k]) > std::abs(normal[largest])) largest = k;
  std::array<std::array<double, 3>, 3> found{normal};
  std::size_t count = 1;
  for (std::size_t k = 0; k < d; ++k) {
    if (k == largest) continue;
    std::array<double, 3> tangent{};
    tangent[k] = 1.0;
    for (std::size_t f = 0; f < count; ++f) {
      const double along = found[f][0] * tangent[0] + found[f][1] * tangent[1] + found[f][2] * tangent[2];
      for (std::size_t i = 0; i < 3; ++i) tangent[i] -= along * found[f][i];
    }
    const double size = std::hypot(tangent[0], tangent[1], tangent[2]);
    for (double& one : tangent) one /= size;
    found[count++] = tangent;
    basis.push_back({0.0, tangent[0], tangent[1], tangent[2], 0.0});
  }
  basis.emplace_back();
  basis.back()[d + 1] = 1.0;
  return basis;
}

/// Returns λ of the mirrored Maxwellian.
multipliers_of_wall mirrored(const std::array<double, 3>& normal, multipliers_of_wall of, std::size_t d) {
  double along = 0.0;
  for (std::size_t k = 0; k < d; ++k) along += of[k + 1] * normal[k];
  for (std::size_t k = 0; k < d; ++k) of[k + 1] -= 2.0 * along * normal[k];
  return of;
}

/// Returns all unit vectors.
std::array<multipliers_of_wall, 5> full_basis() {
  std::array<multipliers_of_wall, 5> basis{};
  for (std::size_t k = 0; k < basis.size(); ++k) basis[k][k] = 1.0;
  return basis;
}

/// Returns memory for at least n numbers of this thread.
template <int Use>
double* memory_of_wall(std::size_t n) {
  thread_local std::vector<double> memory;
  if (memory.size() < n) memory.resize(n);
  return memory.data();
}

}  // namespace

oblique_reflection::oblique_reflection(const velocity_set& velocities)
    : velocities_(velocities), axes_(velocities) {
  if (velocities.sets() > 2)
    throw input_error(
        fmt::format("the model has {} sets of components (a wall with any normal reflects one or two); use "
                    "another boundary",
                    velocities.sets()));
}

oblique_reflection::report oblique_reflection::reflect(const std::array<double, 3>& normal,
                                                       const double* inward, const double* arriving,
                                                       double* values) const {
  if (mirror(normal, inward, arriving, values)) return {};
  const std::size_t all = at(velocities_.components());
  double least = 0.0, most = 0.0;
  for (std::size_t k = 0; k < all; ++k) {
    const double value = inward[k] < 0.0 ? arriving[k] : 0.0;
    least = std::min(least, value);
    most = std::max(most, value);
  }
  if (least == 0.0) return reflect_nonnegative(normal, inward, arriving, most, values);
  double *part = memory_of_wall<0>(all), *negative = memory_of_wall<1>(all);
  for (std::size_t k = 0; k < all; ++k) part[k] = std::max(arriving[k], 0.0);
  const report a = reflect_nonnegative(normal, inward, part, most, values);
  for (std::size_t k = 0; k < all; ++k) part[k] = std::max(-arriving[k], 0.0);
  const report b = reflect_nonnegative(normal, inward, part, -least, negative);
  for (std::size_t k = 0; k < all; ++k)
    if (inward[k] > 0.0) values[k] -= negative[k];
  return {a.is_matched && b.is_matched, a.passes + b.passes};
}

/// Reflects exactly at a normal along a symmetric axis. Returns false for other normals.
bool oblique_reflection::mirror(const std::array<double, 3>& normal, const double* inward,
                                const double* arriving, double* values) const {
  for (std::size_t k = 0; k < axes_.dimensions(); ++k) {
    if (std::abs(normal[k]) != 1.0 || !axes_.is_symmetric(k)) continue;
    const std::size_t stride = axes_.stride(k), points = axes_.points(k).size();
    for (std::size_t j = 0; j < at(velocities_.components()); ++j) {
      const std::size_t i = j / stride % points;
      if (inward[j] > 0.0) values[j] = arriving[j - i * stride + (points - 1 - i) * stride];
    }
    return true;
  }
  return false;
}

/// flux ← w |v·n| times the scaled values of a set for components with the given sign of v·n, 0 for others.
/// Returns the sum.
double oblique_reflection::flux_of(std::size_t set, double sign, const double* inward, const double* values,
                                   double scale, double* flux) const {
  const std::size_t n = axes_.size();
  const double* weights = velocities_.weights().data();
  double sum = 0.0;
  for (std::size_t j = 0; j < n; ++j) {
    const double speed = sign * inward[j];
    flux[j] = speed > 0.0 ? weights[j] * speed * (values[set * n + j] * scale) : 0.0;
    sum += flux[j];
  }
  return sum;
}

oblique_reflection::report oblique_reflection::reflect_nonnegative(const std::array<double, 3>& normal,
                                                                   const double* inward,
                                                                   const double* arriving, double most,
                                                                   double* values) const {
  constexpr double least_share = 1e-3;  // with a smaller part of the flux, interpolation has missed the gas
  constexpr int most_binary = 1000;
  const std::size_t n = axes_.size(), sets = at(velocities_.sets());
  int binary = 0;
  std::frexp(most, &binary);
  binary = std::clamp(binary, -most_binary, most_binary);
  const double scale = std::ldexp(1.0, -binary), unscale = std::ldexp(1.0, binary);
  double* flux = memory_of_wall<2>(n);
  const reference gas = reference_of(normal, inward, arriving, scale, flux);
  double* ratios = memory_of_wall<3>(sets * n);
  divide(gas, inward, arriving, scale, ratios);
  mirrored_interpolation::gather(axes_, normal, inward, sets, ratios, values);
  const multipliers_of_wall leaving = mirrored(normal, gas.multipliers, axes_.dimensions());
  for (std::size_t s = 0; s < sets; ++s) multiply(gas.family, leaving, inward, s, values);

  exponential_family::match found;
  flux_of(0, 1.0, inward, values, 1.0, flux);
  if (gas.wanted[0] > 0.0) {
    const auto basis = basis_of_wall(normal, axes_.dimensions());
    found = gas.family.solve(flux, gas.wanted, {basis.data(), basis.size()}, {});
  }
  if (!found.is_solved) found.multipliers = {};
  report made{found.is_solved || gas.wanted[0] == 0.0, gas.passes + found.passes};
  for (std::size_t s = 0; s < sets; ++s) {
    multiply(gas.family, found.multipliers, inward, s, values);
    const double arrived = flux_of(s, -1.0, inward, arriving, scale, flux),
                 leaves = flux_of(s, 1.0, inward, values, 1.0, flux);
    const double factor = arrived == 0.0 ? 0.0 : arrived / leaves;
    if (factor * least_share < 1.0 && std::isfinite(leaves)) {
      for (std::size_t j = 0; j < n; ++j)
        values[s * n + j] = inward[j] > 0.0 ? values[s * n + j] * (factor * unscale) : 0.0;
    } else {
      made.is_matched = false;
      mirrored_interpolation::deposit(axes_, normal, inward, velocities_.weights().data(), arriving + s * n,
                                      values + s * n);
    }
  }
  return made;
}

/// Computes M; λ is 0 if Newton's method does not find it.
oblique_reflection::reference oblique_reflection::reference_of(const std::array<double, 3>& normal,
                                                               const double* inward, const double* arriving,
                                                               double scale, double* flux) const {
  const std::size_t d = axes_.dimensions(), n = axes_.size();
  const auto sum_of = [&](const exponential_family& family) {
    exponential_family::table ones;
    family.tabulate({}, ones);
    return family.sum(flux, ones).first;
  };
  flux_of(0, -1.0, inward, arriving, scale, flux);
  const auto raw = sum_of(exponential_family(axes_, {}, 1.0));
  double along = 0.0, square = 2.0 * raw[d + 1] / raw[0];
  for (std::size_t k = 0; k < d; ++k) along += raw[k + 1] / raw[0] * normal[k];
  std::array<double, 3> origin{};
  for (std::size_t k = 0; k < d; ++k) {
    origin[k] = raw[k + 1] / raw[0] - along * normal[k];
    square -= origin[k] * origin[k];
  }
  if (!(raw[0] > 0.0) || !std::isfinite(square)) return {exponential_family(axes_, {}, 1.0), {}, raw};
  square = std::max(square, along * along);
  const auto start = gaussian_of_fluxes(-along, square, static_cast<int>(d));
  const double variance = start ? start->variance : square / static_cast<double>(d + 1);
  reference made{exponential_family(axes_, origin, std::sqrt(variance))};
  made.wanted = sum_of(made.family);
  made.passes = 2;
  if (!start) return made;
  multipliers_of_wall first{};
  for (std::size_t k = 0; k < d; ++k) first[k + 1] = -start->drift * normal[k];
  first[d + 1] = -1.0;
  const double* weights = velocities_.weights().data();
  for (std::size_t j = 0; j < n; ++j) flux[j] = weights[j] * std::max(-inward[j], 0.0);
  exponential_family::table factors;
  if (!made.family.tabulate(first, factors)) return made;
  first[0] = std::log(made.wanted[0] / made.family.sum(flux, factors).first[0]);
  static const auto basis = full_basis();
  const auto found = made.family.solve(flux, made.wanted, {basis.data(), d + 2}, first);
  made.passes += found.passes + 1;
  if (!found.is_solved) return made;
  const double largest = made.family.largest_exponent(found.multipliers);
  for (std::size_t k = 1; k < d + 2; ++k)
    made.multipliers[k] = found.multipliers[k] * std::min(1.0, most_exponent / largest);
  return made;
}

/// ratios ← scale f/M of components with v·n < 0, and 0 for others.
void oblique_reflection::divide(const reference& by, const double* inward, const double* arriving,
                                double scale, double* ratios) const {
  const std::size_t n = axes_.last().size();
  multipliers_of_wall inverse = by.multipliers;
  for (double& one : inverse) one = -one;
  exponential_family::table factors;
  by.family.tabulate(inverse, factors);
  const double* last = by.family.last(factors);
  for (std::size_t first = 0; first < at(velocities_.components()); first += axes_.size())
    for (std::size_t line = 0; line < axes_.lines(); ++line) {
      const double common = by.family.factor_of_line(factors, axes_.indices_of_line(line));
      for (std::size_t i = 0, j = first + line * n; i < n; ++i, ++j)
        ratios[j] = inward[j] < 0.0 ? arriving[j] * scale * (common * last[i]) : 0.0;
    }
}

/// Multiplies the values of a set by exp(ν·φ) for components with v·n > 0.
void oblique_reflection::multiply(const exponential_family& family, const multipliers_of_wall& multipliers,
                                  const double* inward, std::size_t set, double* values) const {
  const std::size_t n = axes_.last().size();
  exponential_family::table factors;
  family.tabulate(multipliers, factors);
  const double* last = family.last(factors);
  for (std::size_t line = 0; line < axes_.lines(); ++line) {
    const double common = family.factor_of_line(factors, axes_.indices_of_line(line));
    const std::size_t first = line * n;
    for (std::size_t i = 0; i < n; ++i)
      if (inward[first + i] > 0.0) values[set * axes_.size() + first + i] *= common * last[i];
  }
}

}  // namespace apsis
