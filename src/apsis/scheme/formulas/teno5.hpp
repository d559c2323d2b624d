#if defined(APSIS_SCHEME_FORMULAS_TENO5) == defined(HWY_TARGET_TOGGLE)
#ifdef APSIS_SCHEME_FORMULAS_TENO5
#undef APSIS_SCHEME_FORMULAS_TENO5
#else
#define APSIS_SCHEME_FORMULAS_TENO5
#endif

#include <apsis/exec/number.hpp>
#include <apsis/scheme/formulas/weno5.hpp>

APSIS_BEFORE_FORMULAS();
namespace apsis::APSIS_NUMBERS {

/// The weights of TENO (Fu, Hu & Adams, JCP 305, 2016, with C_T = 1e-5 and q = 6). Let γ_k = ((β_k + δ +
/// τ)/(β_k + δ))⁶ with τ = |β₀ − β₂|. g_k is 0 if γ_k is less than 1e-5 times the sum of all three, else 1.
/// A candidate has its linear weight or none. On smooth data the scheme is therefore the linear one, with
/// its dispersion.
struct weights_teno : weno5::weights_relative_to_data {
  static constexpr double cutoff = 1e-5;

  /// The bases of the powers have a common denominator and are relative to their sum. No power overflows
  /// then, and a power that underflows is far below the cutoff. The largest base is at least 1/3, so that its
  /// power exceeds the cutoff.
  template <class N>
  static APSIS_FORMULA weno5::factors<N> factors(const weno5::smoothness<N>& y) {
    const N tau = absolute(y.s0 - y.s2);
    const N b0 = (y.s0 + tau) * (y.s1 * y.s2), b1 = (y.s1 + tau) * (y.s0 * y.s2),
            b2 = (y.s2 + tau) * (y.s0 * y.s1), per_sum = N(1.0) / (b0 + b1 + b2);
    const N g0 = sixth_power(b0 * per_sum), g1 = sixth_power(b1 * per_sum), g2 = sixth_power(b2 * per_sum),
            least = N(cutoff) * (g0 + g1 + g2);
    return {kept(g0, least), kept(g1, least), kept(g2, least)};
  }

 private:
  template <class N>
  static APSIS_FORMULA N sixth_power(N x) {
    const N square = x * x;
    return square * square * square;
  }
  template <class N>
  static APSIS_FORMULA N kept(N g, N least) {
    return select(g < least, N(0.0), N(1.0));
  }
};

}  // namespace apsis::APSIS_NUMBERS
APSIS_AFTER_FORMULAS();

#endif
