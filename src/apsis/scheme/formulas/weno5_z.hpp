#if defined(APSIS_SCHEME_FORMULAS_WENO5_Z) == defined(HWY_TARGET_TOGGLE)
#ifdef APSIS_SCHEME_FORMULAS_WENO5_Z
#undef APSIS_SCHEME_FORMULAS_WENO5_Z
#else
#define APSIS_SCHEME_FORMULAS_WENO5_Z
#endif

#include <apsis/exec/number.hpp>
#include <apsis/scheme/formulas/weno5.hpp>

APSIS_BEFORE_FORMULAS();
namespace apsis::APSIS_NUMBERS {

/// The weights g_k = 1 + (τ/(β_k + δ))², τ = |β₀ − β₂| (Borges, Carmona, Costa & Don, JCP 227, 2008). The
/// power 2 preserves fifth order at smooth extrema.
struct weights_z : weno5::weights_relative_to_data {
  template <class N>
  static APSIS_FORMULA weno5::factors<N> factors(const weno5::smoothness<N>& y) {
    const N tau = y.s0 - y.s2, t = tau * tau;
    const N z0 = y.s0 * y.s0, z1 = y.s1 * y.s1, z2 = y.s2 * y.s2;
    const N m0 = z1 * z2, m1 = z0 * z2, m2 = z0 * z1, all = m2 * z2;
    return {fma(t, m0, all), fma(t, m1, all), fma(t, m2, all)};
  }
};

/// weights_z with δ = u²: jumps by less than the value count as smooth. Weights then hardly change where f
/// jumps along rays, so that iterations to a steady state converge there.
struct weights_z_smooth : weights_z {
  template <class Window>
  static APSIS_FORMULA auto smoothness(const Window& u) {
    return weno5::relative_to_data(u, 1.0);
  }
};

}  // namespace apsis::APSIS_NUMBERS
APSIS_AFTER_FORMULAS();

#endif
