#include <paper/broadwell_riemann.hpp>

#include <apsis/core/errors.hpp>

#include <cmath>
#include <numbers>

#include <fmt/format.h>

namespace apsis::paper {
namespace {

/// The two characteristic families, as signs in their formulas.
using family = double;
constexpr family slow = -1.0, fast = 1.0;

double characteristic_speed(double u, family wave) {
  return 0.5 * (u + wave * std::sqrt(2.0 - u * u));
}

/// Returns ln ρ along a rarefaction, up to a constant.
double rarefaction_log(double u, family wave) {
  const double theta = std::asin(u / std::numbers::sqrt2);
  return wave * theta - std::log(std::cos(theta) - wave * std::sin(theta));
}

/// Returns the root x of (1 − u²)x² − (3u − u₀)x − 2 = 0 that has the sign of the family. Behind a shock into
/// (ρ₀, u₀) with velocity u the density is ρ₀(1 + (u − u₀)x), and the shock has the speed u + 1/x. The
/// formula avoids cancellation for weak shocks.
double shock_root(double u0, double u, family wave) {
  const double a = 1.0 - u * u, b = 3.0 * u - u0;
  const double root = std::sqrt(b * b + 8.0 * a);
  return wave * b > 0.0 ? (b + wave * root) / (2.0 * a) : -4.0 / (b - wave * root);
}

/// Returns the density where the velocity is u, behind a wave of the family into (ρ₀, u₀). The slow wave is a
/// shock if u < u₀, the fast one if u > u₀.
double density_behind(double rho0, double u0, double u, family wave) {
  if (wave * (u - u0) > 0.0) return rho0 * (1.0 + (u - u0) * shock_root(u0, u, wave));
  return rho0 * std::exp(rarefaction_log(u, wave) - rarefaction_log(u0, wave));
}

}  // namespace

broadwell_riemann::broadwell_riemann(state left, state right)
    : left_{left.rho, left.m / left.rho}, right_{right.rho, right.m / right.rho}, middle_{} {
  for (const side& given : {left_, right_})
    if (!(given.rho > 0.0) || !(std::abs(given.u) < 1.0))
      throw input_error(fmt::format(
          "no Riemann problem for density {:g} and velocity {:g} (the limit system is hyperbolic for "
          "positive density and velocities below that of the particles); give rho > 0 and |m| < rho",
          given.rho, given.u));
  // Towards u = −1 the density behind the slow wave exceeds that behind the fast one; towards u = 1 the
  // reverse holds.
  double low = -1.0, high = 1.0;
  for (int k = 0; k < 200 && low < high; ++k) {
    const double u = 0.5 * (low + high);
    if (u == low || u == high) break;
    const bool above =
        density_behind(left_.rho, left_.u, u, slow) > density_behind(right_.rho, right_.u, u, fast);
    (above ? low : high) = u;
  }
  middle_.u = 0.5 * (low + high);
  middle_.rho = density_behind(left_.rho, left_.u, middle_.u, slow);
}

broadwell_riemann::state broadwell_riemann::middle() const {
  return {middle_.rho, middle_.rho * middle_.u};
}

std::array<double, 2> broadwell_riemann::slow_wave() const {
  if (middle_.u < left_.u) {
    const double s = middle_.u + 1.0 / shock_root(left_.u, middle_.u, slow);
    return {s, s};
  }
  return {characteristic_speed(left_.u, slow), characteristic_speed(middle_.u, slow)};
}

std::array<double, 2> broadwell_riemann::fast_wave() const {
  if (middle_.u > right_.u) {
    const double s = middle_.u + 1.0 / shock_root(right_.u, middle_.u, fast);
    return {s, s};
  }
  return {characteristic_speed(middle_.u, fast), characteristic_speed(right_.u, fast)};
}

broadwell_riemann::state broadwell_riemann::at(double speed) const {
  const auto first = slow_wave(), second = fast_wave();
  const auto whole = [](const side& s) { return state{s.rho, s.rho * s.u}; };
  // λ∓(u) = ξ has the solution u = ξ ± √(1 − ξ²).
  const auto inside = [speed](const side& from, family wave) {
    const double u = speed - wave * std::sqrt(1.0 - speed * speed);
    const double rho = density_behind(from.rho, from.u, u, wave);
    return state{rho, rho * u};
  };
  if (speed < first[0]) return whole(left_);
  if (speed < first[1]) return inside(left_, slow);
  if (speed < second[0]) return whole(middle_);
  if (speed < second[1]) return inside(right_, fast);
  return whole(right_);
}

}  // namespace apsis::paper
