// The formulas of limiter.hpp for packs of numbers.
#if defined(APSIS_SPACE_LIMITER_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef APSIS_SPACE_LIMITER_INL_HPP
#undef APSIS_SPACE_LIMITER_INL_HPP
#else
#define APSIS_SPACE_LIMITER_INL_HPP
#endif

#include <apsis/core/simd-inl.hpp>
#include <apsis/space/limiter.hpp>

HWY_BEFORE_NAMESPACE();
namespace apsis::HWY_NAMESPACE::limiter {

using apsis::limiter::end_weight;
using apsis::limiter::floor;

/// Not negative, and 0 instead of NaN.
template <class N>
HWY_INLINE N nonnegative(N x) {
  return select(x > N(0.0), x, N(0.0));
}

template <class N>
HWY_INLINE N scaling(N c, N m) {
  const N wanted = floor * c;
  return nonnegative(select(m < wanted, (c - wanted) / (c - m), N(1.0)));
}

template <class N>
HWY_INLINE N interior(N c, N l, N r) {
  return (c - end_weight * (l + r)) * (1.0 / (1.0 - 2.0 * end_weight));
}

/// limiter::harmless_fraction in two parts, since most cells do no harm.
template <class N>
class bearing {
 public:
  HWY_INLINE bearing(N u_up, N u, N a_in, N a_out)
      : wanted_((1.0 - floor) * fma(N(1.0 - end_weight), u, end_weight * u_up)),
        harm_(end_weight * (nonnegative(a_out) + nonnegative(-a_in))) {}

  /// Some component has a fraction below 1.
  HWY_INLINE bool too_much() const { return N::any(harm_ > wanted_); }
  HWY_INLINE N fraction() const { return nonnegative(select(harm_ > wanted_, wanted_ / harm_, N(1.0))); }

 private:
  N wanted_, harm_;
};

}  // namespace apsis::HWY_NAMESPACE::limiter
HWY_AFTER_NAMESPACE();

#endif
