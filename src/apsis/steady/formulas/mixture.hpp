// The formula of steady/mixture_rows.hpp.
#if defined(APSIS_STEADY_FORMULAS_MIXTURE) == defined(HWY_TARGET_TOGGLE)
#ifdef APSIS_STEADY_FORMULAS_MIXTURE
#undef APSIS_STEADY_FORMULAS_MIXTURE
#else
#define APSIS_STEADY_FORMULAS_MIXTURE
#endif

#include <apsis/exec/number.hpp>

APSIS_BEFORE_FORMULAS();
namespace apsis::APSIS_NUMBERS {

/// Computes three sums term by term: the image g = x + δ, the last image x / factor + Σ_j θ_j Δg_j, and the
/// mixture g − Σ_j θ_j Δg_j with other θ.
template <class N>
struct image_mixture {
  N image, last, mixed;

  APSIS_FORMULA image_mixture(N x, N delta, N inverse_factor)
      : image(x + delta), last(x * inverse_factor), mixed(image) {}
  APSIS_FORMULA void recall(N theta, N difference) { last = fma(theta, difference, last); }
  APSIS_FORMULA N difference() const { return image - last; }
  APSIS_FORMULA void take_off(N theta, N difference) { mixed = negative_fma(theta, difference, mixed); }
};

}  // namespace apsis::APSIS_NUMBERS
APSIS_AFTER_FORMULAS();

#endif
