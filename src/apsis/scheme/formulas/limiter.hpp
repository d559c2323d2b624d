// The limiters of scheme/limiter.hpp.
#if defined(APSIS_SCHEME_FORMULAS_LIMITER) == defined(HWY_TARGET_TOGGLE)
#ifdef APSIS_SCHEME_FORMULAS_LIMITER
#undef APSIS_SCHEME_FORMULAS_LIMITER
#else
#define APSIS_SCHEME_FORMULAS_LIMITER
#endif

#include <apsis/exec/number.hpp>
#include <apsis/scheme/limiter.hpp>

APSIS_BEFORE_FORMULAS();
namespace apsis::APSIS_NUMBERS::limiter {

using apsis::limiter::absolute_margin;
using apsis::limiter::end_weight;
using apsis::limiter::negligible;
using apsis::limiter::relative_margin;

/// Returns max(x, 0), and 0 for NaN.
template <class N>
APSIS_FORMULA N nonnegative(N x) {
  return select(x > N(0.0), x, N(0.0));
}

template <class N>
APSIS_FORMULA N lower_bound(N c) {
  return minimum(fma(N(relative_margin), c, N(absolute_margin)), c);
}

/// Computes limiter::scaling() with bound = lower_bound(c).
template <class N>
APSIS_FORMULA N scaling(N c, N m, N bound) {
  return nonnegative(select(m < bound, (c - bound) / (c - m), N(1.0)));
}

template <class N>
APSIS_FORMULA N interior(N c, N l, N r) {
  return (c - end_weight * (l + r)) * (1.0 / (1.0 - 2.0 * end_weight));
}

/// Returns true only if u > negligible and 0.01 u < edge < (inverse_cfl − 0.01) u for all components. If this
/// holds for a cell and its upstream neighbour, A_out⁺ < (inverse_cfl − 1.01) u and A_in⁻ < 0.99 u_up.
/// limiter_coefficient() allows more, by far more than rounding errors and margins. The corrections then need
/// no limiting.
template <class N>
APSIS_FORMULA bool is_moderate(N u, N edge, N inverse_cfl) {
  const N middle = N(0.5) * inverse_cfl;
  return all<N>(absolute(fma(-middle, u, edge)) < fma(middle - N(0.01), u, middle * N(-negligible)));
}

/// Computes limiter::limiter_coefficient() in two parts, because the corrections of most cells need no
/// limiting. `inverse_cfl` is 1/κ.
template <class N>
class harm_bound {
 public:
  APSIS_FORMULA harm_bound(N low_order_up, N low_order, N u, N a_in, N a_out, N inverse_cfl)
      : allowed_(maximum(fma(N(1.0 - relative_margin), fma(inverse_cfl, u, -low_order) + low_order_up,
                             inverse_cfl * N(-absolute_margin)),
                         N(0.0))),
        harm_(maximum(a_out, N(0.0)) - minimum(a_in, N(0.0))) {}

  /// Whether some component has a fraction below 1.
  APSIS_FORMULA bool exceeded() const { return any<N>(harm_ > allowed_); }
  APSIS_FORMULA N fraction() const { return nonnegative(select(harm_ > allowed_, allowed_ / harm_, N(1.0))); }

 private:
  N allowed_, harm_;
};

/// Limits the edge values of a cell of average c. Returns false if neither changes.
template <class N>
APSIS_FORMULA bool limit_edges(N c, N& left, N& right) {
  const N lowest = smaller(smaller(left, right), interior(c, left, right)), bound = lower_bound(c);
  if (!any<N>(lowest < bound)) return false;
  const N theta = scaling(c, lowest, bound);
  const auto limited = theta < N(1.0);
  left = select(limited, fma(theta, left - c, c), left);
  right = select(limited, fma(theta, right - c, c), right);
  return true;
}

}  // namespace apsis::APSIS_NUMBERS::limiter
APSIS_AFTER_FORMULAS();

#endif
