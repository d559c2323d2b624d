// Linear edge values.
#if defined(APSIS_SCHEME_FORMULAS_UPWIND) == defined(HWY_TARGET_TOGGLE)
#ifdef APSIS_SCHEME_FORMULAS_UPWIND
#undef APSIS_SCHEME_FORMULAS_UPWIND
#else
#define APSIS_SCHEME_FORMULAS_UPWIND
#endif

#include <apsis/exec/number.hpp>

APSIS_BEFORE_FORMULAS();
namespace apsis::APSIS_NUMBERS {

/// Values below it have edges 0: in several directions the fluxes of a cell round separately, and three
/// subnormal numbers may round to more than their sum (docs/space.md, "Rounding").
constexpr double negligible = 1e-270;

/// Both edges of a cell in the first-order upwind scheme.
template <class N>
APSIS_FORMULA N upwind1_edge(N u) {
  return select(absolute(u) < N(negligible), N(0.0), u);
}

/// Right edge of the cell c of five, from the quartic through their averages; the left one by mirror
/// symmetry.
template <class N>
APSIS_FORMULA N upwind5_edge(N a, N b, N c, N d, N e) {
  return c + (N(2.0) * (a - c) - N(13.0) * (b - c) + N(27.0) * (d - c) - N(3.0) * (e - c)) / N(60.0);
}

}  // namespace apsis::APSIS_NUMBERS
APSIS_AFTER_FORMULAS();

#endif
