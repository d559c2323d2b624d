#if defined(APSIS_SCHEME_FORMULAS_WENO5_JS) == defined(HWY_TARGET_TOGGLE)
#ifdef APSIS_SCHEME_FORMULAS_WENO5_JS
#undef APSIS_SCHEME_FORMULAS_WENO5_JS
#else
#define APSIS_SCHEME_FORMULAS_WENO5_JS
#endif

#include <apsis/exec/number.hpp>
#include <apsis/scheme/formulas/weno5.hpp>

APSIS_BEFORE_FORMULAS();
namespace apsis::APSIS_NUMBERS {

/// The weights g_k = 1/(β_k + 1e-6)² (Jiang & Shu, JCP 126, 1996). The constant 1e-6 is that of the reference
/// and has the unit of the data squared. Because of it no product underflows. No product overflows for
/// differences below 1e18.
struct weights_js {
  static constexpr double added = 1e-6;
  static constexpr bool of_any_size = false;

  template <class Window>
  static APSIS_FORMULA auto smoothness(const Window& u) {
    return weno5::indicators(u);
  }
  template <class N>
  static APSIS_FORMULA weno5::factors<N> factors(const weno5::smoothness<N>& y) {
    const N z0 = y.s0 * y.s0, z1 = y.s1 * y.s1, z2 = y.s2 * y.s2;
    return {z1 * z2, z0 * z2, z0 * z1};
  }
};

}  // namespace apsis::APSIS_NUMBERS
APSIS_AFTER_FORMULAS();

#endif
