#pragma once

namespace apsis {

/// Weights of the convex combination v = of_u·u + of_e·E. It solves v = u + a Q(v) + b Q̇(v) for a relaxation
/// Q(u) = C (E − u)/ε with conserved moments. The weights are nonnegative, and of_u + of_e rounds to 1.
template <class Real>
struct relaxation_weights {
  Real of_u,  ///< weight of u
      of_e;   ///< weight of E
};

/// Computes of_u = 1/(1 + μ), of_e = μ/(1 + μ) with μ = a C/ε + |b| (C/ε)², using Q̇ = −(C/ε) Q (paper,
/// Property 5 and eq. AP1). All arguments are dimensionless: a = Δt d ≥ 0, b = Δt² ḋ ≤ 0, `rate` = C ≥ 0,
/// `epsilon` = ε ≥ 0. Each weight is accurate to about an ulp, however small. μ = ∞ (ε = 0, or (C/ε)²
/// overflows) gives exactly {0, 1}. a = b = 0 gives exactly {1, 0}, even for ε = 0. NaN arguments give
/// NaN, except if a = b = 0, or if C = 0 and only ε is NaN. The function has no branches, so that loops
/// over it vectorize.
template <class Real>
constexpr relaxation_weights<Real> relax_weights(Real a, Real b, Real rate, Real epsilon) {
  const Real k = rate > Real(0) || rate != rate ? rate / epsilon : Real(0);  // avoids 0/0 for C = ε = 0
  const Real first = a == Real(0) ? Real(0) : a * k;                         // avoids 0·∞ for ε = 0
  const Real second = b == Real(0) ? Real(0) : -b * k * k;
  const Real mu = first + second;
  // Dividing for the smaller weight, and subtracting it from 1 for the larger one, avoids
  // cancellation in both.
  const Real smaller = (Real(1) < mu ? Real(1) : mu) / (Real(1) + mu);
  const Real larger = Real(1) - smaller;
  return mu <= Real(1) ? relaxation_weights<Real>{larger, smaller}
                       : relaxation_weights<Real>{smaller, larger};
}

/// Returns the largest c for which v = of_u·u + of_e·E stays nonnegative whenever u ≥ 0 and E ≥ −c u, less a
/// margin for the rounding of the combination. Returns 0 if of_e = 0.
constexpr double kept_part(const relaxation_weights<double>& weights) {
  constexpr double margin = 1e-13;
  return weights.of_e > 0.0 ? (1.0 - margin) * (weights.of_u / weights.of_e) : 0.0;
}

/// The coefficients of a stage, multiplied by powers of the collision rate C/ε (dimensionless).
struct stage_coefficients {
  double a = 0.0,         ///< A = aC/ε
      b = 0.0,            ///< B = |b|(C/ε)²
      weight_of_b = 0.0;  ///< B/(A + B); 0 if both are 0
};

/// Returns the coefficients for C/ε, which may be infinite. The arguments are those of relax_weights().
constexpr stage_coefficients coefficients_of_stage(double a, double b, double rate, double epsilon) {
  const double k = rate > 0.0 || rate != rate ? rate / epsilon : 0.0;
  stage_coefficients of;
  of.a = a == 0.0 ? 0.0 : a * k;
  const double once = b == 0.0 ? 0.0 : -b * k;  // B/A without overflow of B
  of.b = once == 0.0 ? 0.0 : once * k;
  const bool infinite = once - once != 0.0;
  if (once > 0.0) of.weight_of_b = infinite ? 1.0 : once / (a + once);
  return of;
}

}  // namespace apsis
