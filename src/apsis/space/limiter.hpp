#pragma once

namespace apsis {

/// Positivity limiter of Zhang & Shu (JCP 229, 2010) with the four-point Gauss–Lobatto rule, whose end weight
/// is ŵ₁ = 1/12: a cell average c is ŵ₁ L + (1 − 2ŵ₁) ξ* + ŵ₁ R, and if L, R, ξ* ≥ 0 then a forward Euler
/// step of upwind transport with Δt ≤ ŵ₁ Δx/v keeps the average nonnegative.
namespace limiter {

/// ŵ₁, the weight of each of the two edges.
inline constexpr double end_weight = 1.0 / 12.0;

/// Values are kept above this fraction of the average instead of above 0, so that the rounding of the update
/// (a few 1e-16) cannot cross zero. Accuracy does not see it.
inline constexpr double floor = 1e-13;

/// θ ∈ [0, 1] such that c + θ(m − c) ≥ floor·c, where m is the smallest value to be mended; for c ≤ 0 it is
/// 0.
inline double scaling(double c, double m) {
  const double wanted = floor * c;
  const double room = c - wanted;
  const double theta = m < wanted ? room / (c - m) : 1.0;
  return theta > 0.0 ? theta : 0.0;
}

/// The value ξ* that the average implies between the edges.
inline double interior(double c, double l, double r) {
  return (c - end_weight * (l + r)) * (1.0 / (1.0 - 2.0 * end_weight));
}

/// left, right (rows of `width` edge values of one cell) move towards the averages c.
void apply(const double* c, int width, double* left, double* right);

/// For point values: their flux function is not nonnegative where the solution touches zero (near a minimum
/// it is lower by Δx² u''/24), so edges must not be cut at zero. Instead the flux into and out of a cell are
/// limited together, between first-order upwind and the high-order edge (as in Xu, Math. Comp. 83, 2014, or
/// Zalesak, JCP 31, 1979). Seen in the direction of motion, with the values u_up, u, the corrections A = edge
/// − donor of the inflow and the outflow: the fraction R ∈ [0, 1] of the corrections that harm this cell,
/// such that
///   u − κ (u + R A_out⁺ − u_up + R A_in⁻) ≥ 0,  κ = end_weight.
inline double harmless_fraction(double u_up, double u, double a_in, double a_out) {
  const double kept = (1.0 - end_weight) * u + end_weight * u_up;
  const double harm = end_weight * ((a_out > 0.0 ? a_out : 0.0) - (a_in < 0.0 ? a_in : 0.0));
  const double wanted = (1.0 - floor) * kept;
  const double fraction = harm > wanted ? wanted / harm : 1.0;
  return fraction > 0.0 ? fraction : 0.0;
}

}  // namespace limiter
}  // namespace apsis
