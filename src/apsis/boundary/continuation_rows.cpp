#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "apsis/boundary/continuation_rows.cpp"
#include <hwy/foreach_target.h>

#include <apsis/boundary/continuation_rows.hpp>

#include <apsis/boundary/formulas/continuation.hpp>

HWY_BEFORE_NAMESPACE();
namespace apsis::HWY_NAMESPACE {

void fill(const double* a0, const double* a1, const double* a2, int width, std::span<double* const> ghosts) {
  for_packs(width, [&](auto lanes, int k) APSIS_PACKED {
    using N = pack<decltype(lanes)>;
    const continuation<N> beyond(N::load(a0 + k), N::load(a1 + k), N::load(a2 + k));
    N ghost(1.0);
    for (double* row : ghosts) {
      beyond.average(ghost).store(row + k);
      ghost = ghost + N(1.0);
    }
  });
}

}  // namespace apsis::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace apsis {
namespace {
HWY_EXPORT(fill);
}  // namespace

void continuation_rows::fill(const std::array<const double*, 3>& inside, int width,
                             std::span<double* const> ghosts) {
  HWY_DYNAMIC_DISPATCH(fill)(inside[0], inside[1], inside[2], width, ghosts);
}

}  // namespace apsis
#endif
