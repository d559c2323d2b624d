#pragma once

namespace apsis {

/// Limiters for which forward Euler steps of upwind transport stay nonnegative (docs/space.md, "Positivity").
namespace limiter {

/// Quadrature weight ŵ₁ of each edge in the four-point Gauss–Lobatto rule (Zhang & Shu, JCP 229, 2010). A
/// cell average is c = ŵ₁ L + (1 − 2ŵ₁) ξ* + ŵ₁ R. If L, R, ξ* ≥ 0, a step with Δt ≤ ŵ₁ Δx/v keeps the
/// average nonnegative.
inline constexpr double end_weight = 1.0 / 12.0;

/// Limited values stay above this fraction of the average (or of K, see limiter_coefficient()) instead of
/// above 0. Rounding errors of the update are a few 1e-16 of the average, so that the result stays positive.
/// The order of accuracy is unaffected.
inline constexpr double relative_margin = 1e-13;

/// Absolute part of the margin. Close to the smallest normal number 2.2e-308 rounding errors are absolute
/// (half of 4.9e-324). Averages below this margin have first-order upwind fluxes, which stay nonnegative
/// under rounding (docs/space.md, "Rounding").
inline constexpr double absolute_margin = 1e-290;

/// Returns the lower bound of the limited values in a cell of average c: relative_margin·c + absolute_margin,
/// but at most c.
inline double lower_bound(double c) {
  const double bound = relative_margin * c + absolute_margin;
  return bound < c ? bound : c;
}

/// Returns the largest θ ∈ [0, 1] such that c + θ(m − c) ≥ lower_bound(c), where m ≤ c is the smallest value
/// to be limited. Returns 0 for NaN, and for c ≤ absolute_margin if m < c.
inline double scaling(double c, double m) {
  const double bound = lower_bound(c);
  const double theta = m < bound ? (c - bound) / (c - m) : 1.0;
  return theta > 0.0 ? theta : 0.0;
}

/// Returns the value ξ* between the edges that follows from the average c and the edge values l, r.
inline double interior(double c, double l, double r) {
  return (c - end_weight * (l + r)) * (1.0 / (1.0 - 2.0 * end_weight));
}

/// Limits the edge values `left` and `right` of a cell (rows of `width` numbers) by scaling them towards
/// the averages c.
void apply(const double* c, int width, double* left, double* right);

/// Smaller values do not flow out of their cell. The fluxes of a cell in several directions round separately,
/// and three subnormal numbers may round to more than their sum (docs/space.md, "Rounding").
inline constexpr double negligible = 1e-270;

/// Returns the value at the edge of a cell in the first-order upwind scheme.
inline double low_order_edge(double u) {
  return u < negligible && u > -negligible ? 0.0 : u;
}

/// Least CFL number κ for which fluxes are limited. At smaller ones, from slow velocities or short steps,
/// fluxes hardly need a limiter.
inline constexpr double least_cfl_number = 1e-3;
/// Returns 1/κ of the limiter of steady states, where no step determines κ. `leaving` is the rate Λ at which
/// a velocity leaves a cell, and `collisions` the slowest rate of collisions σ at the start. The change of a
/// cell may depend (Λ/κ + σ)/(Λ + σ) times as much on its value as in a sweep of the steady iteration, which
/// is of first order. This ratio is at most 2 even if collisions become three times slower on the way.
inline double steady_inverse_cfl(double leaving, double collisions) {
  const double found = 2.0 + collisions / (3.0 * leaving);
  return found < 1.0 / least_cfl_number ? found : 1.0 / least_cfl_number;
}

/// Limits fluxes. The flux function of point values may be negative where the solution touches zero: near a
/// minimum it is lower by Δx² u''/24. Edge values must therefore not be cut off at zero. Instead, the fluxes
/// into and out of a cell are limited together, between first-order upwind and high-order edges (as in Xu,
/// Math. Comp. 83, 2014, or Zalesak, JCP 31, 1979). Let u_up, u ≥ 0 be values in the direction of motion, w =
/// low_order_edge(u), and A = edge − w the corrections of inflow and outflow. A⁺ = max(A, 0) and A⁻ = max(−A,
/// 0). Returns the fraction ϑ ∈ [0, 1] of the corrections that decrease u, such that
///     u − κ (w + ϑ A_out⁺ − w_up + ϑ A_in⁻) ≥ absolute_margin
/// if K = u − κ w + κ w_up is large enough. ϑ = 0 if K is below the margin. `inverse_cfl` is 1/κ ≥ 1: an
/// outflow of 1/κ times the value would empty the cell.
inline double limiter_coefficient(double u_up, double u, double a_in, double a_out, double inverse_cfl) {
  // Both sides are divided by κ, because κ A may underflow to 0.
  const double kept = inverse_cfl * u - low_order_edge(u) + low_order_edge(u_up);
  const double harm = (a_out > 0.0 ? a_out : 0.0) - (a_in < 0.0 ? a_in : 0.0);
  const double left = (1.0 - relative_margin) * kept - inverse_cfl * absolute_margin;
  const double allowed = left > 0.0 ? left : 0.0;
  const double fraction = harm > allowed ? allowed / harm : 1.0;
  return fraction > 0.0 ? fraction : 0.0;
}

}  // namespace limiter
}  // namespace apsis
