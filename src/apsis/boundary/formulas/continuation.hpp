// The formulas of boundary/continuation_rows.hpp.
#if defined(APSIS_BOUNDARY_FORMULAS_CONTINUATION) == defined(HWY_TARGET_TOGGLE)
#ifdef APSIS_BOUNDARY_FORMULAS_CONTINUATION
#undef APSIS_BOUNDARY_FORMULAS_CONTINUATION
#else
#define APSIS_BOUNDARY_FORMULAS_CONTINUATION
#endif

#include <apsis/exec/number.hpp>

APSIS_BEFORE_FORMULAS();
namespace apsis::APSIS_NUMBERS {

template <class N>
APSIS_FORMULA N squared(N x) {
  return x * x;
}

/// Returns the factor of a continuation: 1 − x² with x = (s² − d²)²/(s⁴ + d⁴ + e⁴), e = a/2, and the two
/// differences s, d next to a value a. It is 1 for constant data and 1 − O(Δx¹²) for smooth data. It is near
/// 0 if one difference vanishes and the other one is larger than a. Like the weights of WENO it is a rational
/// function, so that T(u) is smooth and methods keep their order in time.
template <class N>
APSIS_FORMULA N share_kept(N s, N d, N a) {
  const N e = N(0.5) * a;  // differences below half the value are always continued
  const N scale = inverse_power_of_two(larger(larger(absolute(s), absolute(d)), absolute(e)));
  const N s2 = squared(s * scale), d2 = squared(d * scale), e2 = squared(e * scale),
          all = fma(s2, s2, fma(d2, d2, e2 * e2));
  const N kept = fma(N(2.0) * s2, d2, e2 * e2) / all;  // 1 − x without cancellation
  return select(all > N(0.0), kept * (N(2.0) - kept), N(1.0));
}

/// The continuation of three cell averages a0, a1, a2 beyond a face, a0 being next to it.
template <class N>
struct continuation {
  N first, slope, curvature, factor;

  APSIS_FORMULA continuation(N a0, N a1, N a2)
      : first(a0), slope(a0 - a1), curvature(slope - (a1 - a2)), factor(share_kept(slope, a1 - a2, a0)) {}
  /// Returns the average of ghost cell `ghost` = 1, 2, …
  APSIS_FORMULA N average(N ghost) const {
    return fma(factor * ghost, fma(N(0.5) * (ghost + N(1.0)), curvature, slope), first);
  }
};

}  // namespace apsis::APSIS_NUMBERS
APSIS_AFTER_FORMULAS();

#endif
