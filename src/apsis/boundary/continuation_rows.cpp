#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "apsis/boundary/continuation_rows.cpp"
#include <hwy/foreach_target.h>

#include <apsis/boundary/continuation_rows.hpp>

#include <apsis/boundary/formulas/continuation.hpp>

HWY_BEFORE_NAMESPACE();
namespace apsis::HWY_NAMESPACE {

template <class N>
HWY_INLINE void store_ghosts(const continuation<N>& beyond, std::span<double* const> ghosts, int k) {
  N ghost(1.0);
  for (double* row : ghosts) {
    beyond.average(ghost).store(row + k);
    ghost = ghost + N(1.0);
  }
}

void fill(const double* a0, const double* a1, const double* a2, int width, std::span<double* const> ghosts) {
  for_packs(width, [&](auto lanes, int k) APSIS_PACKED {
    using N = pack<decltype(lanes)>;
    store_ghosts(continuation<N>(N::load(a0 + k), N::load(a1 + k), N::load(a2 + k)), ghosts, k);
  });
}

void fill_at_border(const double* a0, const double* a1, const double* a2, const double* inward, int width,
                    std::span<double* const> ghosts) {
  for_packs(width, [&](auto lanes, int k) APSIS_PACKED {
    using N = pack<decltype(lanes)>;
    continuation<N> beyond(N::load(a0 + k), N::load(a1 + k), N::load(a2 + k));
    beyond.curvature = select(N::load(inward + k) > N(0.0), N(0.0), beyond.curvature);
    store_ghosts(beyond, ghosts, k);
  });
}

}  // namespace apsis::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace apsis {
namespace {
HWY_EXPORT(fill);
HWY_EXPORT(fill_at_border);
}  // namespace

void continuation_rows::fill(const std::array<const double*, 3>& inside, int width,
                             std::span<double* const> ghosts) {
  HWY_DYNAMIC_DISPATCH(fill)(inside[0], inside[1], inside[2], width, ghosts);
}

void continuation_rows::fill_at_border(const std::array<const double*, 3>& inside, const double* inward,
                                       int width, std::span<double* const> ghosts) {
  HWY_DYNAMIC_DISPATCH(fill_at_border)(inside[0], inside[1], inside[2], inward, width, ghosts);
}

}  // namespace apsis
#endif
