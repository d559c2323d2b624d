#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "apsis/model/relaxation_rows.cpp"
#include <hwy/foreach_target.h>

#include <apsis/model/relaxation_rows.hpp>

#include <apsis/model/formulas/relaxation.hpp>

HWY_BEFORE_NAMESPACE();
namespace apsis::HWY_NAMESPACE {

void combine(double share, const double* base, const double* other, int width, double* result) {
  for_packs(width, [&](auto lanes, int k) APSIS_PACKED {
    using N = pack<decltype(lanes)>;
    moved_towards(N::load(base + k), N(share), N::load(other + k)).store(result + k);
  });
}

void mean_of_three(const relaxation::weighted_rows* of_points, int width, double* mean) {
  // A local copy shows the compiler that storing the mean does not change the points.
  const relaxation::weighted_rows points[3] = {of_points[0], of_points[1], of_points[2]};
  for_packs(width, [&](auto lanes, int k) APSIS_PACKED {
    using N = pack<decltype(lanes)>;
    N sum(0.0);
    for (const auto& point : points)
      sum =
          with_part(sum, N(point.weight), N::load(point.base + k), N(point.share), N::load(point.other + k));
    sum.store(mean + k);
  });
}

void mean_of_any(const relaxation::weighted_rows* points, int count, int width, double* mean) {
  for_packs(width, [&](auto lanes, int k) APSIS_PACKED {
    using N = pack<decltype(lanes)>;
    N sum(0.0);
    for (const auto& point : std::span(points, static_cast<std::size_t>(count)))
      sum =
          with_part(sum, N(point.weight), N::load(point.base + k), N(point.share), N::load(point.other + k));
    sum.store(mean + k);
  });
}

void change(double strength, const double* e, const double* u, int width, double* q) {
  for_packs(width, [&](auto lanes, int k) APSIS_PACKED {
    using N = pack<decltype(lanes)>;
    relaxation_rate(N(strength), N::load(e + k), N::load(u + k)).store(q + k);
  });
}

}  // namespace apsis::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace apsis {
namespace {
HWY_EXPORT(combine);
HWY_EXPORT(mean_of_three);
HWY_EXPORT(mean_of_any);
HWY_EXPORT(change);
}  // namespace

namespace relaxation {

void combine(double weight_of_u, double weight_of_e, const double* e, int width, double* u) {
  if (weight_of_e <= weight_of_u) return HWY_DYNAMIC_DISPATCH(combine)(weight_of_e, u, e, width, u);
  HWY_DYNAMIC_DISPATCH(combine)(weight_of_u, e, u, width, u);
}

void mean(std::span<const weighted_rows> points, int width, double* mean) {
  if (points.size() == 3) {
    HWY_DYNAMIC_DISPATCH(mean_of_three)(points.data(), width, mean);
  } else {
    HWY_DYNAMIC_DISPATCH(mean_of_any)(points.data(), static_cast<int>(points.size()), width, mean);
  }
}

void change(double strength, const double* e, const double* u, int width, double* q) {
  HWY_DYNAMIC_DISPATCH(change)(strength, e, u, width, q);
}

}  // namespace relaxation
}  // namespace apsis
#endif
