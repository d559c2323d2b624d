// The formulas of semidiscrete/face_rows.hpp.
#if defined(APSIS_SEMIDISCRETE_FORMULAS_FACE) == defined(HWY_TARGET_TOGGLE)
#ifdef APSIS_SEMIDISCRETE_FORMULAS_FACE
#undef APSIS_SEMIDISCRETE_FORMULAS_FACE
#else
#define APSIS_SEMIDISCRETE_FORMULAS_FACE
#endif

#include <apsis/exec/number.hpp>

APSIS_BEFORE_FORMULAS();
namespace apsis::APSIS_NUMBERS {

/// Returns the value of components that leave the domain, and 0 for others.
template <class N>
APSIS_FORMULA N if_leaving(N inward, N value) {
  return select(inward < N(0.0), value, N(0.0));
}

/// Returns `entering` for components that enter, and `value` for others.
template <class N>
APSIS_FORMULA N if_entering(N inward, N entering, N value) {
  return select(inward > N(0.0), entering, value);
}

/// Returns acc + β (v·n/Δx) value for components that enter, and acc for others.
template <class N>
APSIS_FORMULA N with_entering(N acc, N beta, N inward, N spacing, N value) {
  return if_entering(inward, acc + (beta * (inward / spacing)) * value, acc);
}

}  // namespace apsis::APSIS_NUMBERS
APSIS_AFTER_FORMULAS();

#endif
