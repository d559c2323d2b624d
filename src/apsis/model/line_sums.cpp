#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "apsis/model/line_sums.cpp"
#include <hwy/foreach_target.h>

#include <apsis/model/line_sums.hpp>

#include <apsis/model/formulas/line.hpp>

#include <algorithm>
#include <cstddef>

HWY_BEFORE_NAMESPACE();
namespace apsis::HWY_NAMESPACE {

using N = pack<wide>;

HWY_INLINE double total(N x) {
  return hn::GetLane(hn::SumOfLanes(wide(), x.v));
}

line_sums::values weigh(const double* x, const double* c, const double* base, int n, double beta, double tau,
                        double shift, double* w) {
  const int length = static_cast<int>(hn::Lanes(wide()));
  sums_of_weights<N> sums;
  for (int j = 0; j < n; j += length) {
    const N at = N::load(x + j), parabola = N::load(c + j);
    const N weight = line_weight(at, parabola, N(beta), N(tau), N(shift));
    const auto inside = hn::FirstN(wide(), static_cast<std::size_t>(std::min(n - j, length)));
    N kept(hn::IfThenElseZero(inside, weight.v));
    if (base != nullptr) kept = kept * N::load(base + j);
    kept.store(w + j);
    sums.add(kept, at, parabola);
  }
  return {total(sums.mass), total(sums.above), total(sums.below), total(sums.energy)};
}

line_sums::products multiply(const double* x, const double* c, const double* w, int n) {
  const int length = static_cast<int>(hn::Lanes(wide()));
  sums_of_products<N> sums;
  for (int j = 0; j < n; j += length) sums.add(N::load(w + j), N::load(x + j), N::load(c + j));
  return {total(sums.above_x), total(sums.above_c), total(sums.below_x), total(sums.below_c), total(sums.cc)};
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
