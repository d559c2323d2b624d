// Linear edge values.
#if defined(APSIS_SCHEME_FORMULAS_UPWIND) == defined(HWY_TARGET_TOGGLE)
#ifdef APSIS_SCHEME_FORMULAS_UPWIND
#undef APSIS_SCHEME_FORMULAS_UPWIND
#else
#define APSIS_SCHEME_FORMULAS_UPWIND
#endif

#include <apsis/exec/number.hpp>
#include <apsis/scheme/limiter.hpp>

APSIS_BEFORE_FORMULAS();
namespace apsis::APSIS_NUMBERS {

/// Returns both edges of a cell in the first-order upwind scheme, limiter::low_order_edge(u).
template <class N>
APSIS_FORMULA N upwind1_edge(N u) {
  return select(absolute(u) < N(limiter::negligible), N(0.0), u);
}

/// Returns the right edge of cell c from the quartic through the averages of five cells a … e. The left edge
/// follows by mirror symmetry.
template <class N>
APSIS_FORMULA N upwind5_edge(N a, N b, N c, N d, N e) {
  const N upstream = fma(N(2.0 / 60.0), a - c, N(-13.0 / 60.0) * (b - c));
  return fma(N(27.0 / 60.0), d - c, fma(N(-3.0 / 60.0), e - c, c + upstream));
}

}  // namespace apsis::APSIS_NUMBERS
APSIS_AFTER_FORMULAS();

#endif
