// The formulas of semidiscrete/lattice_rows.hpp.
#if defined(APSIS_SEMIDISCRETE_FORMULAS_LATTICE) == defined(HWY_TARGET_TOGGLE)
#ifdef APSIS_SEMIDISCRETE_FORMULAS_LATTICE
#undef APSIS_SEMIDISCRETE_FORMULAS_LATTICE
#else
#define APSIS_SEMIDISCRETE_FORMULAS_LATTICE
#endif

#include <apsis/exec/number.hpp>

APSIS_BEFORE_FORMULAS();
namespace apsis::APSIS_NUMBERS {

/// acc + β change, and 0 between −2^−1022 and 0: there two roundings of subnormal numbers exceed the value.
template <class N>
APSIS_FORMULA N with_change(N acc, N beta, N change) {
  const N sum = acc + beta * change;
  return select(sum < N(0.0), select(sum > N(-0x1p-1022), N(0.0), sum), sum);
}

}  // namespace apsis::APSIS_NUMBERS
APSIS_AFTER_FORMULAS();

#endif
