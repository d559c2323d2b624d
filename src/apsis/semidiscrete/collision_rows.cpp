#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "apsis/semidiscrete/collision_rows.cpp"
#include <hwy/foreach_target.h>

#include <apsis/semidiscrete/collision_rows.hpp>

#include <apsis/exec/counted.hpp>
#include <apsis/scheme/formulas/quartic.hpp>
#include <apsis/semidiscrete/formulas/collision.hpp>

HWY_BEFORE_NAMESPACE();
namespace apsis::HWY_NAMESPACE {

void add(std::span<const collision_rows::weighted_row> points, const double* u, int width,
         std::span<const upwind::row_target> targets) {
  for_packs(width, [&](auto lanes, int k) APSIS_PACKED {
    using N = pack<decltype(lanes)>;
    N change(0.0);
    for (const auto& p : points) change = with_collision(change, N(p.weight), N::load(p.q + k));
    const N here = N::load(u + k);
    for (const auto& to : targets) {
      const N add = collision_part(N(to.alpha), here, N(to.beta), change);
      (to.fresh ? add : N::load(to.acc + k) + add).store(to.acc + k);
    }
  });
}

template <bool Limited>
HWY_INLINE void quartics(collision_rows::quartic_rows cell, int width, double* points) {
  for_packs(width, [&](auto lanes, int k) APSIS_PACKED {
    using N = pack<decltype(lanes)>;
    const auto [g0, g1, g2] =
        quartic_values<Limited>(N::load(cell.before + k), N::load(cell.average + k), N::load(cell.after + k),
                                N::load(cell.left + k), N::load(cell.right + k));
    g0.store(points + k);
    g1.store(points + width + k);
    g2.store(points + 2 * static_cast<std::ptrdiff_t>(width) + k);
  });
}

double operations_of_points(bool limited) {
  const counted x(0.0);
  return counted::operations_of([&] {
    if (limited) {
      quartic_values<true>(x, x, x, x, x);
    } else {
      quartic_values<false>(x, x, x, x, x);
    }
  });
}

void gauss_values(const collision_rows::quartic_rows& cell, bool limited, int width, double* points) {
  if (limited) {
    quartics<true>(cell, width, points);
  } else {
    quartics<false>(cell, width, points);
  }
}

}  // namespace apsis::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace apsis {
namespace {
HWY_EXPORT(add);
HWY_EXPORT(gauss_values);
}  // namespace

namespace collision_rows {

void add(std::span<const weighted_row> points, const double* u, int width,
         std::span<const upwind::row_target> targets) {
  HWY_DYNAMIC_DISPATCH(add)(points, u, width, targets);
}

double operations_of_points(bool limited) {
  static const double with = HWY_NAMESPACE::operations_of_points(true),
                      without = HWY_NAMESPACE::operations_of_points(false);
  return limited ? with : without;
}

void gauss_values(const quartic_rows& cell, bool limited, int width, double* points) {
  HWY_DYNAMIC_DISPATCH(gauss_values)(cell, limited, width, points);
}

}  // namespace collision_rows
}  // namespace apsis
#endif
