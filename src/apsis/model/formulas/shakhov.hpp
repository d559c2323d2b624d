// The target of Shakhov's model (model/models/shakhov.cpp).
#if defined(APSIS_MODEL_FORMULAS_SHAKHOV) == defined(HWY_TARGET_TOGGLE)
#ifdef APSIS_MODEL_FORMULAS_SHAKHOV
#undef APSIS_MODEL_FORMULAS_SHAKHOV
#else
#define APSIS_MODEL_FORMULAS_SHAKHOV
#endif

#include <apsis/core/relaxation_weights.hpp>
#include <apsis/exec/number.hpp>
#include <apsis/model/fluid_state.hpp>
#include <apsis/model/formulas/target_moments.hpp>

APSIS_BEFORE_FORMULAS();
namespace apsis::APSIS_NUMBERS {

/// heat_k ← ½ (Σ_l third(k, l) + of_h(k)) in d directions, with third(k, l) = Σ c_k c_l² g and of_h(k) =
/// Σ c_k h.
template <class Third, class OfH>
APSIS_FORMULA void find_heat_flux(int d, const Third& third, const OfH& of_h, double* heat) {
  for (int k = 0; k < d; ++k) {
    heat[k] = 0.0;
    for (int l = 0; l < d; ++l) heat[k] += 0.5 * third(k, l);
    heat[k] += 0.5 * of_h(k);
  }
}

/// Shakhov's target M [1 + (1 − Pr) q·c/(5pT) (|c|²/T − 5)], c = v − u, in d directions. Its moments are
/// not corrected.
struct shakhov_target {
  double prandtl;

  /// Returns the factor by which a stage multiplies the heat flux q.
  APSIS_FORMULA double decay(const stage_coefficients& of) const {
    return 1.0 / (1.0 + prandtl * of.a + prandtl * prandtl * of.b);
  }
  /// Returns the weight λB/(A + B) of Q̇ in the target of a stage, with λ = Pr.
  APSIS_FORMULA double weight_of_derivative(const stage_coefficients& of) const {
    return prandtl * of.weight_of_b;
  }
  /// Returns the target for `part` times the heat flux q. `derivative` is the weight of Q̇.
  APSIS_FORMULA target_shape shape(int d, const fluid_state& state, const double* q, double derivative,
                                   double part) const {
    const double scale = (1.0 - prandtl) * (1.0 + derivative) / (5.0 * state.rho * state.T * state.T);
    target_shape of;
    of.variance = state.T;
    for (int k = 0; k < d; ++k) {
      const double along = part * scale * q[k];
      of.of_g.l[k] = -(d + 2.0) * along;
      of.of_h.l[k] = -static_cast<double>(d) * along;
      of.of_g.w[k] = of.of_h.w[k] = along / state.T;
    }
    return of;
  }
};

}  // namespace apsis::APSIS_NUMBERS
APSIS_AFTER_FORMULAS();

#endif
