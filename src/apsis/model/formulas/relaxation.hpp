// The formulas of model/relaxation_rows.hpp.
#if defined(APSIS_MODEL_FORMULAS_RELAXATION) == defined(HWY_TARGET_TOGGLE)
#ifdef APSIS_MODEL_FORMULAS_RELAXATION
#undef APSIS_MODEL_FORMULAS_RELAXATION
#else
#define APSIS_MODEL_FORMULAS_RELAXATION
#endif

#include <apsis/exec/number.hpp>

APSIS_BEFORE_FORMULAS();
namespace apsis::APSIS_NUMBERS {

/// Returns the convex combination (1 − share) base + share other, 0 ≤ share ≤ ½.
template <class N>
APSIS_FORMULA N moved_towards(N base, N share, N other) {
  return fma(share, other - base, base);
}

/// Returns sum + weight base + share (other − base), which adds a quadrature point to a mean.
template <class N>
APSIS_FORMULA N with_part(N sum, N weight, N base, N share, N other) {
  return fma(share, other - base, fma(weight, base, sum));
}

/// Returns strength (e − u).
template <class N>
APSIS_FORMULA N relaxation_rate(N strength, N e, N u) {
  return strength * (e - u);
}

}  // namespace apsis::APSIS_NUMBERS
APSIS_AFTER_FORMULAS();

#endif
