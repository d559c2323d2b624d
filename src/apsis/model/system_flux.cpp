#include <apsis/model/system_flux.hpp>

#include <apsis/core/errors.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <utility>

#include <Eigen/Eigenvalues>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace apsis {
namespace {

constexpr int most = system_flux::most_variables;
using square_matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, most, most>;

/// Scales rows and columns by powers of 2 until their norms agree within a factor of 2 (Parlett, Reinsch,
/// Numer. Math. 13, 1969). Otherwise eigenvalues would lose digits if variables have different units.
void balance(square_matrix& a) {
  const Eigen::Index n = a.rows();
  for (bool changed = true; changed;) {
    changed = false;
    for (Eigen::Index k = 0; k < n; ++k) {
      const double row = a.row(k).cwiseAbs().sum() - std::abs(a(k, k));
      const double column = a.col(k).cwiseAbs().sum() - std::abs(a(k, k));
      if (!(row > 0.0 && column > 0.0)) continue;
      const double by = std::exp2(std::round(0.5 * std::log2(row / column)));
      if (!std::isfinite(by) || !(column * by + row / by < 0.95 * (column + row))) continue;
      a.col(k) *= by;
      a.row(k) /= by;
      changed = true;
    }
  }
}

/// Returns the characteristic speeds of two equations: λ = m ± √d with mean m and discriminant d.
system_flux::waves waves_of_two(const square_matrix& a) {
  const double mean = 0.5 * (a(0, 0) + a(1, 1)), half = 0.5 * (a(0, 0) - a(1, 1));
  const double discriminant = half * half + a(0, 1) * a(1, 0), root = std::sqrt(std::abs(discriminant));
  if (discriminant >= 0.0) return {std::abs(mean) + root, 0.0};
  return {std::hypot(mean, root), root};
}

/// Returns the characteristic speeds of three equations: λ = m + z, where m is the mean and z³ − 3pz − 2q = 0
/// (Viète and Cardano). This is many times as fast as an iteration. The coefficients do not depend on the
/// units of variables.
system_flux::waves waves_of_three(const square_matrix& a) {
  const double mean = (a(0, 0) + a(1, 1) + a(2, 2)) / 3.0;
  const Eigen::Matrix3d b = a - mean * Eigen::Matrix3d::Identity();
  const double p = (b(0, 0) * b(0, 0) + b(1, 1) * b(1, 1) + b(2, 2) * b(2, 2) +
                    2.0 * (b(0, 1) * b(1, 0) + b(0, 2) * b(2, 0) + b(1, 2) * b(2, 1))) /
                   6.0,
               q = 0.5 * b.determinant();
  const double discriminant = q * q - p * p * p;
  if (discriminant <= 0.0) {
    const double r = 2.0 * std::sqrt(p),
                 angle = std::acos(std::clamp(q / (p * std::sqrt(p)), -1.0, 1.0)) / 3.0;
    const double largest = r * std::cos(angle), smallest = -r * std::cos(std::numbers::pi / 3.0 - angle);
    return {p > 0.0 ? std::max(std::abs(mean + largest), std::abs(mean + smallest)) : std::abs(mean), 0.0};
  }
  const double t = std::cbrt(q + std::copysign(std::sqrt(discriminant), q)), z = t + p / t;
  const double imaginary = std::sqrt(std::max(0.0, 0.75 * z * z - 3.0 * p));
  return {std::max(std::abs(mean + z), std::hypot(mean - 0.5 * z, imaginary)), imaginary};
}

system_flux::waves waves_of(square_matrix a) {
  if (a.rows() == 1) return {std::abs(a(0, 0)), 0.0};
  if (a.rows() == 2) return waves_of_two(a);
  if (a.rows() == 3) return waves_of_three(a);
  balance(a);
  const Eigen::EigenSolver<square_matrix> solver(a, false);
  system_flux::waves found;
  if (solver.info() != Eigen::Success) return {std::numeric_limits<double>::quiet_NaN(), 0.0};
  for (Eigen::Index k = 0; k < a.rows(); ++k) {
    const auto lambda = solver.eigenvalues()[k];
    found.speed = std::max(found.speed, std::abs(lambda));
    found.imaginary = std::max(found.imaginary, std::abs(lambda.imag()));
  }
  return found;
}

}  // namespace

system_flux::system_flux(std::vector<std::string> variables, const std::vector<std::string>& formulas,
                         const formula_constants& constants, const std::string& key)
    : variables_(std::move(variables)) {
  if (variables_.empty() || variables_.size() > static_cast<std::size_t>(most_variables))
    throw input_error(
        fmt::format("model.variables has {} names (a law has from 1 to {} variables); give the "
                    "names of the conserved quantities",
                    variables_.size(), most_variables));
  if (const std::string why = why_not_variables(variables_, constants); !why.empty())
    throw input_error(fmt::format("model.variables cannot be used ({}); choose other names", why));
  if (formulas.size() != variables_.size())
    throw input_error(
        fmt::format("{} has {} formula{} (each of the {} variables {} has one flux); give {} formulas", key,
                    formulas.size(), formulas.size() == 1 ? "" : "s", variables_.size(),
                    fmt::join(variables_, ", "), variables_.size()));
  for (const auto& formula : formulas)
    formulas_.emplace_back(formula, source_place{}, formula_kind{variables_, false, constants});
}

void system_flux::evaluate(const double* u, int points, double* F) const {
  const auto n = variables_.size(), count = static_cast<std::size_t>(points);
  for (std::size_t k = 0; k < n; ++k) formulas_[k].values({u, n * count}, {F + k * count, count});
}

void system_flux::evaluate_columns(const double* u, int points, double* F) const {
  const auto n = variables_.size(), count = static_cast<std::size_t>(points);
  for (std::size_t k = 0; k < n; ++k) formulas_[k].values_of_columns({u, n * count}, {F + k * count, count});
}

namespace {

/// First step of a difference in units of the size of a variable, and the factor from each step to the next.
constexpr double first_step = 2.5e-4, shrinking_factor = 0.125;

/// A slope from F at u + h, u − h, u + 2h and u − 2h, by Richardson extrapolation of central differences.
struct slope_of_four {
  slope_of_four(const double* f, std::size_t apart, double h) {
    const double once = (f[0] - f[apart]) / (2.0 * h), twice = (f[2 * apart] - f[3 * apart]) / (4.0 * h);
    slope = (4.0 * once - twice) / 3.0;
    noise = 1e-14 * (std::abs(f[2 * apart]) + std::abs(f[3 * apart])) / h;
    error = std::abs(once - twice);
  }
  /// Whether the error is at most 1e-6 of the slope, up to rounding. The error of the extrapolation, of order
  /// h⁴, is then close to the square of this error. Where the slope vanishes, the error must be much smaller
  /// than at the start. False for NaN.
  bool is_accurate(double at_start) const {
    const double vanishing = std::abs(slope) <= error ? at_start : 0.0;
    return error <= 1e-6 * (std::abs(slope) + vanishing) + noise;
  }

  double slope, error,  ///< error of the less accurate difference
      noise;            ///< rounding error of the slope
};

}  // namespace

/// The slopes of several states by their first step. F is evaluated for all states together. Numbers of a
/// kind are contiguous over the states.
struct system_flux::differences {
  std::vector<double> u, sizes,  ///< values and sizes of variable k
      at, F,  ///< variables j and fluxes F_j after step s of variable k: state p is number (4 k + s) states +
              ///< p of j
      slopes,      ///< slopes of F_j by variable k
      accurate,    ///< 1 if all slopes by variable k are accurate, else 0
      derivative;  ///< F' of one state

  /// Returns the number of states whose values fit into the first-level cache.
  static std::size_t together(std::size_t n) { return std::clamp<std::size_t>(512 / (n * n), 1, 32); }
  void resize(std::size_t n) {
    const std::size_t states = together(n);
    for (auto* of_variables : {&u, &sizes, &accurate}) of_variables->resize(states * n);
    for (auto* of_steps : {&at, &F}) of_steps->resize(states * 4 * n * n);
    slopes.resize(states * n * n);
    derivative.resize(n * n);
  }
  /// derivative ← F' of a state.
  void take_derivative(std::size_t n, std::size_t count, std::size_t state) {
    for (std::size_t k = 0; k < n * n; ++k) derivative[k] = slopes[k * count + state];
  }
};

/// The step h starts at a small part of the size and shrinks until all slopes are accurate.
bool system_flux::differentiate(const double* u, int variable, double size, double* slopes) const {
  constexpr double rounding = 1e-14;
  constexpr int most_shrinkings = 14;
  const auto n = variables_.size(), k = static_cast<std::size_t>(variable);
  std::array<double, 4 * most> at{}, F{};
  std::array<double, most> at_start{};  // errors of the first step
  const auto evaluate_at = [&](const std::array<double, 4>& steps) {
    for (std::size_t p = 0; p < steps.size(); ++p) {
      std::copy_n(u, n, at.begin() + static_cast<std::ptrdiff_t>(p * n));
      at[p * n + k] += steps[p];
    }
    evaluate(at.data(), 4, F.data());
  };
  double h = first_step * size;
  for (int shrinking = 0; shrinking < most_shrinkings; ++shrinking, h *= shrinking_factor) {
    evaluate_at({h, -h, 2.0 * h, -2.0 * h});
    bool enough = true;
    for (std::size_t j = 0; j < n; ++j) {
      const slope_of_four found(F.data() + 4 * j, 1, h);
      slopes[j] = found.slope;
      if (shrinking == 0) at_start[j] = std::isfinite(found.error) ? found.error : 0.0;
      enough = enough && found.is_accurate(at_start[j]);
    }
    if (enough) return true;
  }
  // u may be an end of the interval on which F is defined. A slope that grows as the step shrinks counts
  // as infinite.
  const auto from_one_side = [&](double s, double* found) {
    evaluate_at({0.0, s, 2.0 * s, 0.0});
    for (std::size_t j = 0; j < n; ++j) {
      const double* f = F.data() + 4 * j;
      found[j] = (4.0 * f[1] - f[2] - 3.0 * f[0]) / (2.0 * s);
    }
  };
  std::array<double, most> farther{};
  for (const double s : {1e-6 * size, -1e-6 * size}) {
    from_one_side(16.0 * s, farther.data());
    from_one_side(s, slopes);
    bool finite = true;
    for (std::size_t j = 0; j < n; ++j) {
      const double noise = rounding * std::abs(F[4 * j] / s);
      finite = finite && std::abs(slopes[j]) <= 2.0 * std::abs(farther[j]) + noise;
    }
    if (finite) return true;
  }
  return false;
}

/// A variable that is 0, such as a momentum at rest, takes its size from its flux and from the other
/// variables. The right step may be far from it. Values whose squares underflow count as 0; WENO leaves such
/// values next to exact zeros.
void system_flux::compute_sizes(const double* u, int points, double typical, double* sizes) const {
  constexpr double nothing = 1e-150;
  const std::size_t n = variables_.size(), count = static_cast<std::size_t>(points);
  std::array<double, 32 * most> F;  // NOLINT(cppcoreguidelines-pro-type-member-init): of all states
  evaluate_columns(u, points, F.data());
  for (std::size_t p = 0; p < count; ++p) {
    double largest = 0.0;
    for (std::size_t k = 0; k < n; ++k) {
      const double flux = std::abs(F[k * count + p]) / typical;
      sizes[k * count + p] = std::abs(u[k * count + p]) + (std::isfinite(flux) ? flux : 0.0);
      largest = std::max(largest, sizes[k * count + p]);
    }
    const double least = largest > nothing ? 0.1 * largest : 1.0;
    for (std::size_t k = 0; k < n; ++k) sizes[k * count + p] = std::max(sizes[k * count + p], least);
  }
}

/// Takes the first step of differentiate() for all variables of several states.
void system_flux::take_first_step(int points, double typical, differences& of) const {
  const std::size_t n = variables_.size(), count = static_cast<std::size_t>(points), all = 4 * n * count;
  compute_sizes(of.u.data(), points, typical, of.sizes.data());
  double* at = of.at.data();
  for (std::size_t j = 0; j < n; ++j)
    for (std::size_t k = 0; k < n; ++k)
      for (const double steps : {1.0, -1.0, 2.0, -2.0}) {
        const double *u = of.u.data() + j * count, *sizes = of.sizes.data() + k * count;
        const double by = j == k ? steps : 0.0;
        for (std::size_t p = 0; p < count; ++p) *at++ = u[p] + by * (first_step * sizes[p]);
      }
  evaluate_columns(of.at.data(), static_cast<int>(all), of.F.data());
  std::fill_n(of.accurate.begin(), n * count, 1.0);
  for (std::size_t k = 0; k < n; ++k)
    for (std::size_t j = 0; j < n; ++j) {
      const double *F = of.F.data() + j * all + 4 * k * count, *sizes = of.sizes.data() + k * count;
      double *slopes = of.slopes.data() + (k * n + j) * count, *accurate = of.accurate.data() + k * count;
#pragma omp simd
      for (std::size_t p = 0; p < count; ++p) {
        const slope_of_four found(F + p, count, first_step * sizes[p]);
        slopes[p] = found.slope;
        const double at_start = found.error <= std::numeric_limits<double>::max() ? found.error : 0.0;
        accurate[p] = found.is_accurate(at_start) ? accurate[p] : 0.0;
      }
    }
}

/// derivative[n k + j] ← ∂F_j/∂u_k by steps of the size of u_k alone.
bool system_flux::differentiate_all(const double* u, std::span<double> derivative) const {
  const std::size_t n = variables_.size();
  std::array<double, most> sizes{};
  compute_sizes(u, 1, std::numeric_limits<double>::infinity(), sizes.data());
  for (std::size_t k = 0; k < n; ++k)
    if (!differentiate(u, static_cast<int>(k), sizes[k], &derivative[n * k])) return false;
  return true;
}

void system_flux::derivative_along(const double* u, const double* d, double typical, double* along) const {
  constexpr double part = 1e-5;  // truncation part² and rounding 1e-16/part are both near 1e-11
  const std::size_t n = variables_.size();
  std::array<double, most> sizes{};
  std::array<double, 2 * most> sides{}, F{};
  compute_sizes(u, 1, typical, sizes.data());
  double longest = 0.0;
  for (std::size_t k = 0; k < n; ++k) longest = std::max(longest, std::abs(d[k]) / sizes[k]);
  std::fill_n(along, n, 0.0);
  if (!(longest > 0.0)) return;
  const double h = part / longest;
  for (std::size_t k = 0; k < n; ++k) {
    sides[k] = u[k] + h * d[k];
    sides[n + k] = u[k] - h * d[k];
  }
  evaluate(sides.data(), 2, F.data());
  for (std::size_t k = 0; k < n; ++k)
    if (const double slope = (F[2 * k] - F[2 * k + 1]) / (2.0 * h); std::isfinite(slope)) along[k] = slope;
}

system_flux::waves system_flux::characteristic_speeds(const double* u, double typical) const {
  waves found;
  characteristic_speeds(u, 1, typical, &found);
  return found;
}

void system_flux::characteristic_speeds(const double* u, int points, double typical, waves* found) const {
  const std::size_t n = variables_.size(), all = static_cast<std::size_t>(points);
  thread_local differences of;
  of.resize(n);
  std::array<double, most> state{};
  for (std::size_t done = 0; done < all; done += differences::together(n)) {
    const std::size_t count = std::min(all - done, differences::together(n));
    for (std::size_t k = 0; k < n; ++k) std::copy_n(u + k * all + done, count, &of.u[k * count]);
    take_first_step(static_cast<int>(count), typical, of);
    for (std::size_t p = 0; p < count; ++p) {
      of.take_derivative(n, count, p);
      bool known = true;
      for (std::size_t k = 0; k < n; ++k) {
        if (of.accurate[k * count + p] != 0.0) continue;
        for (std::size_t j = 0; j < n; ++j) state[j] = of.u[j * count + p];
        known = known && differentiate(state.data(), static_cast<int>(k), of.sizes[k * count + p],
                                       &of.derivative[n * k]);
      }
      // If `typical` is far below the speed of the waves, first steps may leave the domain of F.
      if (!known && !differentiate_all(state.data(), of.derivative)) {
        *found++ = {std::numeric_limits<double>::quiet_NaN(), 0.0};
        continue;
      }
      *found++ = waves_of(Eigen::Map<const square_matrix>(of.derivative.data(), size(), size()));
    }
  }
}

std::string system_flux::text_of(const double* u) const {
  std::vector<std::string> parts;
  for (std::size_t k = 0; k < variables_.size(); ++k)
    parts.push_back(fmt::format("{} = {:.6g}", variables_[k], u[k]));
  return fmt::format("{}", fmt::join(parts, ", "));
}

}  // namespace apsis
