// The formulas of limiter.hpp for packs.
#if defined(APSIS_SPACE_LIMITER_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef APSIS_SPACE_LIMITER_INL_HPP
#undef APSIS_SPACE_LIMITER_INL_HPP
#else
#define APSIS_SPACE_LIMITER_INL_HPP
#endif

#include <apsis/exec/simd-inl.hpp>
#include <apsis/scheme/limiter.hpp>

HWY_BEFORE_NAMESPACE();
namespace apsis::HWY_NAMESPACE::limiter {

using apsis::limiter::absolute_margin;
using apsis::limiter::end_weight;
using apsis::limiter::relative_margin;

/// Returns max(x, 0), and 0 for NaN.
template <class N>
HWY_INLINE N nonnegative(N x) {
  return select(x > N(0.0), x, N(0.0));
}

template <class N>
HWY_INLINE N lower_bound(N c) {
  return minimum(fma(N(relative_margin), c, N(absolute_margin)), c);
}

/// limiter::scaling with bound = lower_bound(c).
template <class N>
HWY_INLINE N scaling(N c, N m, N bound) {
  return nonnegative(select(m < bound, (c - bound) / (c - m), N(1.0)));
}

template <class N>
HWY_INLINE N interior(N c, N l, N r) {
  return (c - end_weight * (l + r)) * (1.0 / (1.0 - 2.0 * end_weight));
}

/// Whether 0.01 u < edge < u/ŵ₁ − 0.01 u for all components, with the absolute margin. If this holds for a
/// cell and its upstream neighbour, the corrections do no harm: A_out⁺ < (1/ŵ₁ − 1.01) u and −A_in⁻ < 0.99
/// u_up, which is less than limiter_coefficient() allows by far more than rounding errors.
template <class N>
HWY_INLINE bool is_moderate(N u, N edge) {
  constexpr double middle = 0.5 / end_weight;
  return N::all(absolute(fma(N(-middle), u, edge)) < fma(N(middle - 0.01), u, N(-absolute_margin)));
}

/// limiter::limiter_coefficient in two parts, because the corrections of most cells need no limiting.
template <class N>
class harm_bound {
 public:
  HWY_INLINE harm_bound(N u_up, N u, N a_in, N a_out)
      : allowed_(maximum(fma(N((1.0 - relative_margin) * (1.0 / end_weight - 1.0)), u,
                             fma(N(1.0 - relative_margin), u_up, N(-absolute_margin))),
                         N(0.0))),
        harm_(maximum(a_out, N(0.0)) - minimum(a_in, N(0.0))) {}

  /// Whether some component has a fraction below 1.
  HWY_INLINE bool exceeded() const { return N::any(harm_ > allowed_); }
  HWY_INLINE N fraction() const { return nonnegative(select(harm_ > allowed_, allowed_ / harm_, N(1.0))); }

 private:
  N allowed_, harm_;
};

}  // namespace apsis::HWY_NAMESPACE::limiter
HWY_AFTER_NAMESPACE();

#endif
