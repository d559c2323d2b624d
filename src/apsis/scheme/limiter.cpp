#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "apsis/scheme/limiter.cpp"
#include <hwy/foreach_target.h>

#include <apsis/scheme/formulas/limiter.hpp>

HWY_BEFORE_NAMESPACE();
namespace apsis::HWY_NAMESPACE {

void limit_edges(const double* c, int width, double* left, double* right) {
  for_packs(width, [&](auto lanes, int k) APSIS_PACKED {
    using N = pack<decltype(lanes)>;
    N l = N::load(left + k), r = N::load(right + k);
    if (!limiter::limit_edges(N::load(c + k), l, r)) return;
    l.store(left + k);
    r.store(right + k);
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
