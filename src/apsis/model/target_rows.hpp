#pragma once

namespace apsis {

/// Loops over the points of one velocity direction for targets that are a row times a polynomial, for the
/// instruction set of this processor. c = v − u.
namespace target_rows {

/// k0 + k1 c + k2 c² + k3 c³.
struct cubic {
  double k0 = 1.0,  ///< constant
      k1 = 0.0,     ///< coefficient of c
      k2 = 0.0,     ///< coefficient of c²
      k3 = 0.0;     ///< coefficient of c³
};

/// e ← max(m p(c), −keep f) at n points, f ≥ 0; keep = ∞ leaves m p(c).
void weigh(const double* m, const double* v, double u, const cubic& p, const double* f, double keep, int n,
           double* e);

/// sums[k] ← Σ f c^k, k = 0 … 3.
void power_sums(const double* f, const double* v, double u, int n, double* sums);

}  // namespace target_rows
}  // namespace apsis
