#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "apsis/model/line_sums.cpp"
#include <hwy/foreach_target.h>

#include <apsis/model/line_sums.hpp>

#include <apsis/exec/simd-inl.hpp>

#include <algorithm>
#include <cstddef>

#include <hwy/contrib/math/math-inl.h>

HWY_BEFORE_NAMESPACE();
namespace apsis::HWY_NAMESPACE {

using N = pack<wide>;

HWY_INLINE double total(N x) {
  return hn::GetLane(hn::SumOfLanes(wide(), x.v));
}

line_sums::values weigh(const double* x, const double* c, const double* base, int n, double beta, double tau,
                        double shift, double* w) {
  const int length = static_cast<int>(hn::Lanes(wide()));
  const N limit(691.0), smallest(1e-300), zero(0.0);
  N mass = zero, above = zero, below = zero, energy = zero;
  for (int j = 0; j < n; j += length) {
    const N at = N::load(x + j), parabola = N::load(c + j);
    // Products in this order, and no fused ones: weights do not depend on the instruction set.
    const N exponent = N(beta) * at - N(tau) * parabola - N(shift);
    const N weight(hn::Exp(wide(), smaller(larger(exponent, -limit), limit).v));
    const auto inside = hn::FirstN(wide(), static_cast<std::size_t>(std::min(n - j, length)));
    N kept(hn::IfThenElseZero(inside, select(weight > smallest, weight, zero).v));
    if (base != nullptr) kept = kept * N::load(base + j);
    kept.store(w + j);
    mass = mass + kept;
    above = fma(kept, maximum(at, zero), above);
    below = fma(kept, maximum(-at, zero), below);
    energy = fma(kept, parabola, energy);
  }
  return {total(mass), total(above), total(below), total(energy)};
}

line_sums::products multiply(const double* x, const double* c, const double* w, int n) {
  const int length = static_cast<int>(hn::Lanes(wide()));
  const N zero(0.0);
  N above_x = zero, above_c = zero, below_x = zero, below_c = zero, cc = zero;
  for (int j = 0; j < n; j += length) {
    const N at = N::load(x + j), parabola = N::load(c + j), weight = N::load(w + j);
    const N up = weight * maximum(at, zero), down = weight * maximum(-at, zero);
    above_x = fma(up, at, above_x);
    above_c = fma(up, parabola, above_c);
    below_x = fma(down, at, below_x);
    below_c = fma(down, parabola, below_c);
    cc = fma(weight * parabola, parabola, cc);
  }
  return {total(above_x), total(above_c), total(below_x), total(below_c), total(cc)};
}

}  // namespace apsis::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace apsis {
namespace {
HWY_EXPORT(weigh);
HWY_EXPORT(multiply);
}  // namespace

line_sums::values line_sums::weigh(const double* x, const double* c, const double* base, int n, double beta,
                                   double tau, double shift, double* w) {
  return HWY_DYNAMIC_DISPATCH(weigh)(x, c, base, n, beta, tau, shift, w);
}

line_sums::products line_sums::multiply(const double* x, const double* c, const double* w, int n) {
  return HWY_DYNAMIC_DISPATCH(multiply)(x, c, w, n);
}

}  // namespace apsis
#endif
