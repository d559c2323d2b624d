#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "apsis/scheme/limiter.cpp"
#include <hwy/foreach_target.h>

#include <apsis/scheme/limiter-inl.hpp>

HWY_BEFORE_NAMESPACE();
namespace apsis::HWY_NAMESPACE {

void limit_edges(const double* c, int width, double* left, double* right) {
  for_packs(width, [&](auto lanes, int k) APSIS_PACKED {
    using N = pack<decltype(lanes)>;
    const N average = N::load(c + k), l = N::load(left + k), r = N::load(right + k);
    const N lowest = smaller(smaller(l, r), limiter::interior(average, l, r));
    const N bound = limiter::lower_bound(average);
    if (!N::any(lowest < bound)) return;
    const N theta = limiter::scaling(average, lowest, bound);
    const auto limited = theta < N(1.0);
    select(limited, fma(theta, l - average, average), l).store(left + k);
    select(limited, fma(theta, r - average, average), r).store(right + k);
  });
}

}  // namespace apsis::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace apsis {
namespace {
HWY_EXPORT(limit_edges);
}

void limiter::apply(const double* c, int width, double* left, double* right) {
  HWY_DYNAMIC_DISPATCH(limit_edges)(c, width, left, right);
}

}  // namespace apsis
#endif
