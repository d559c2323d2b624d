// The share of g in the energy of a gas (g, h), and its collision rate (model/gas.hpp).
#if defined(APSIS_MODEL_FORMULAS_REDUCTION) == defined(HWY_TARGET_TOGGLE)
#ifdef APSIS_MODEL_FORMULAS_REDUCTION
#undef APSIS_MODEL_FORMULAS_REDUCTION
#else
#define APSIS_MODEL_FORMULAS_REDUCTION
#endif

#include <apsis/exec/number.hpp>
#include <apsis/model/fluid_state.hpp>
#include <apsis/model/formulas/grid_sums.hpp>

APSIS_BEFORE_FORMULAS();
namespace apsis::APSIS_NUMBERS {

/// Variances of distributions with mean u at the two velocities next to u, and at the two ends.
struct variances {
  double nearest, farthest;
};

/// Returns the variances for n ascending velocities v.
APSIS_FORMULA variances variances_at(const double* v, int n, double u) {
  // Because of rounding, the bulk velocity may lie beyond the last point.
  const double ends = (u - v[0]) * (v[n - 1] - u), farthest = ends < 0.0 ? 0.0 : ends;
  int after = 0;  // number of velocities that are not above u
  for (int behind = n; after < behind;) {
    const int middle = (after + behind) / 2;
    if (u < v[middle]) {
      behind = middle;
    } else {
      after = middle + 1;
    }
  }
  if (after == 0 || after == n) return {0.0, farthest};
  return {(u - v[after - 1]) * (v[after] - u), farthest};
}

/// Returns the variances for n velocities that are `spacing` apart.
APSIS_FORMULA variances variances_at(const double* v, int n, double spacing, double u) {
  const double ends = (u - v[0]) * (v[n - 1] - u), farthest = ends < 0.0 ? 0.0 : ends;
  const double place = u / spacing + 0.5 * (n - 1), beyond = place - __builtin_floor(place);
  return {beyond * (1.0 - beyond) * spacing * spacing, farthest};
}

/// Parts of the energy of the equilibrium (g, h).
struct parts_of_energy {
  double of_g,  ///< 𝓔 of g
      others;   ///< h/g; NaN if no f ≥ 0 has these moments
};

/// A gas whose grid resolves d of D degrees of freedom.
struct reduced_gas {
  int d, degrees;  ///< d < D

  /// Returns the state of the moments ω.
  APSIS_FORMULA fluid_state state(const double* omega) const {
    fluid_state s = to_fluid_state(omega, d);
    s.T *= static_cast<double>(d) / degrees;
    return s;
  }

  /// Returns the parts for moments ω with the state s. `at(k)` are the variances in direction k. Every f ≥ 0
  /// has an equilibrium. If g cannot have the temperature on this grid, because h is small or large compared
  /// to g, g has the nearest possible temperature. This is at most that of equally occupied velocities. h has
  /// the rest of the energy.
  template <class Variances>
  APSIS_FORMULA parts_of_energy parts(const double* omega, const fluid_state& s, const Variances& at) const {
    double square = 0.0, least = 0.0, greatest = 0.0;
    for (int k = 0; k < d; ++k) square += s.u[k] * s.u[k];
    for (int k = 0; k < d; ++k) {
      const variances of = at(k);
      least += of.nearest;
      greatest += of.farthest;
    }
    if (greatest < least) least = greatest;
    const double resolved = d * s.T, usual_energy = 0.5 * s.rho * (square + resolved);
    // All mass of f ≥ 0 may have one velocity. T is then 0 up to the rounding of sums.
    constexpr double rounding = 1e-12;
    if (omega[0] > 0.0 && !(degrees * s.T >= -rounding * (square + greatest)))
      return {usual_energy, __builtin_nan("")};
    const double most = least + (greatest - least) / 3.0, enough = resolved < least ? least : resolved,
                 variance = most < enough ? most : enough;
    const bool usual = !(omega[0] > 0.0) || variance == resolved;
    const double of_g = omega[0] == 0.0 ? omega[d + 1]
                        : usual         ? usual_energy
                                        : 0.5 * s.rho * (square + variance);
    if (!(omega[0] > 0.0)) return {of_g, 0.0};
    const double others = usual ? (degrees - d) * s.T : degrees * s.T - variance;
    return {of_g, others < 0.0 ? 0.0 : others};
  }
};

/// The collision rate C = Pr ρ T^exponent; 0 unless T > 0.
struct rate_by_viscosity {
  double prandtl, exponent;

  APSIS_FORMULA double of(double rho, double T) const {
    if (!(T > 0.0)) return 0.0;
    const double power = exponent == 0.5   ? __builtin_sqrt(T)  // hard spheres
                         : exponent == 1.0 ? T
                                           : exp_of(exponent * log_of_normal(T));
    return prandtl * rho * power;
  }
};

}  // namespace apsis::APSIS_NUMBERS
APSIS_AFTER_FORMULAS();

#endif
