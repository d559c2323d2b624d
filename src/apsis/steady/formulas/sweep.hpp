// The formula of steady/sweep_rows.hpp.
#if defined(APSIS_STEADY_FORMULAS_SWEEP) == defined(HWY_TARGET_TOGGLE)
#ifdef APSIS_STEADY_FORMULAS_SWEEP
#undef APSIS_STEADY_FORMULAS_SWEEP
#else
#define APSIS_STEADY_FORMULAS_SWEEP
#endif

#include <apsis/exec/number.hpp>

APSIS_BEFORE_FORMULAS();
namespace apsis::APSIS_NUMBERS {

/// One equation (Σ_d λ_d here_d + σ) δ = r + Σ_d λ_d (first_d one_d + second_d two_d), term by term.
template <class N>
struct upwind_equation {
  N right, factor;

  APSIS_FORMULA upwind_equation(N r, N rate) : right(r), factor(rate) {}
  APSIS_FORMULA void add(N speed, N here, N first, N one, N second, N two) {
    right = fma(speed, fma(first, one, second * two), right);
    factor = fma(speed, here, factor);
  }
  APSIS_FORMULA void add_rotation(N out, N in, N one) {
    right = fma(in, one, right);
    factor = factor + out;
  }
  APSIS_FORMULA N solution() const { return right / factor; }
};

}  // namespace apsis::APSIS_NUMBERS
APSIS_AFTER_FORMULAS();

#endif
