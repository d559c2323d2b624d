// The formulas of model/target_rows.hpp.
#if defined(APSIS_MODEL_FORMULAS_TARGET) == defined(HWY_TARGET_TOGGLE)
#ifdef APSIS_MODEL_FORMULAS_TARGET
#undef APSIS_MODEL_FORMULAS_TARGET
#else
#define APSIS_MODEL_FORMULAS_TARGET
#endif

#include <apsis/exec/number.hpp>

APSIS_BEFORE_FORMULAS();
namespace apsis::APSIS_NUMBERS {

/// The polynomial k0 + k1 c + k2 c² + k3 c³.
template <class N>
struct cubic_polynomial {
  N k0, k1, k2, k3;
  APSIS_FORMULA N operator()(N c) const { return fma(fma(fma(k3, c, k2), c, k1), c, k0); }
};

/// Raises `value` to at least −keep f. Returns true if some lane was below this bound.
template <class N>
APSIS_FORMULA bool raise(N& value, N keep, N f) {
  const N bound = negative_fma(keep, f, N(0.0));
  const bool raised = any<N>(value < bound);
  value = larger(value, bound);
  return raised;
}

}  // namespace apsis::APSIS_NUMBERS
APSIS_AFTER_FORMULAS();

#endif
