#if defined(APSIS_SCHEME_FORMULAS_QUARTIC) == defined(HWY_TARGET_TOGGLE)
#ifdef APSIS_SCHEME_FORMULAS_QUARTIC
#undef APSIS_SCHEME_FORMULAS_QUARTIC
#else
#define APSIS_SCHEME_FORMULAS_QUARTIC
#endif

#include <apsis/exec/number.hpp>
#include <apsis/scheme/formulas/limiter.hpp>
#include <apsis/scheme/nodes.hpp>

APSIS_BEFORE_FORMULAS();
namespace apsis::APSIS_NUMBERS {

/// Values of the quartic of scheme/quartic.hpp at the Gauss points. The limiter also uses the inner points
/// of the Gauss–Lobatto rule. Each rule gives the average c, so that one number determines the even part at
/// its points.
template <class N>
struct gauss_points {
  N g0, g1, g2;
};

template <bool Limited, class N>
APSIS_FORMULA gauss_points<N> quartic_values(N before, N c, N after, N l, N r) {
  constexpr double outer = gauss3_outer, inner = lobatto4_inner;
  const N to_left = l - c, to_right = r - c, edges = to_left + to_right, slope = r - l;
  const N neighbours = (before - c) + (after - c), rise = after - before;
  const N middle = fma(N(-9.0 / 32.0), edges, N(1.0 / 192.0) * neighbours), even = N(-0.8) * middle;
  // The odd part is ξ (1.25 − ξ²) times the slope plus ξ (ξ²/2 − 1/8) times the rise.
  const N odd =
      fma(N(outer * (1.25 - outer * outer)), slope, N(outer * (0.5 * outer * outer - 0.125)) * rise);
  const N g0 = even - odd, g1 = middle, g2 = even + odd;
  gauss_points<N> values{c + g0, c + g1, c + g2};
  if constexpr (Limited) {
    const N odd_inner =
        fma(N(inner * (1.25 - inner * inner)), slope, N(inner * (0.5 * inner * inner - 0.125)) * rise);
    const N lowest_inner = fma(N(-0.1), edges, c) - absolute(odd_inner);
    const N lowest =
        minimum(minimum(minimum(l, r), minimum(values.g0, values.g1)), minimum(values.g2, lowest_inner));
    const N bound = limiter::lower_bound(c);
    if (any<N>(lowest < bound)) {
      const N theta = limiter::scaling(c, lowest, bound);
      values = {fma(theta, g0, c), fma(theta, g1, c), fma(theta, g2, c)};
    }
  }
  return values;
}

}  // namespace apsis::APSIS_NUMBERS
APSIS_AFTER_FORMULAS();

#endif
