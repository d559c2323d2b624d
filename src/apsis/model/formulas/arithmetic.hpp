// The formulas of model/formula_rows.hpp.
#if defined(APSIS_MODEL_FORMULAS_ARITHMETIC) == defined(HWY_TARGET_TOGGLE)
#ifdef APSIS_MODEL_FORMULAS_ARITHMETIC
#undef APSIS_MODEL_FORMULAS_ARITHMETIC
#else
#define APSIS_MODEL_FORMULAS_ARITHMETIC
#endif

#include <apsis/exec/number.hpp>

APSIS_BEFORE_FORMULAS();
namespace apsis::APSIS_NUMBERS {

/// Return x², x³ and x⁴ by products from left to right.
template <class N>
APSIS_FORMULA N square_of(N x) {
  return x * x;
}
template <class N>
APSIS_FORMULA N cube_of(N x) {
  return x * x * x;
}
template <class N>
APSIS_FORMULA N fourth_power_of(N x) {
  return x * x * x * x;
}

}  // namespace apsis::APSIS_NUMBERS
APSIS_AFTER_FORMULAS();

#endif
