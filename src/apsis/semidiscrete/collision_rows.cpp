#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "apsis/semidiscrete/collision_rows.cpp"
#include <hwy/foreach_target.h>

#include <apsis/semidiscrete/collision_rows.hpp>

#include <apsis/exec/counted.hpp>
#include <apsis/scheme/limiter-inl.hpp>
#include <apsis/scheme/quartic.hpp>

HWY_BEFORE_NAMESPACE();
namespace apsis::HWY_NAMESPACE {

void add(std::span<const collision_rows::weighted_row> points, const double* u, int width,
         std::span<const upwind::row_target> targets) {
  for_packs(width, [&](auto lanes, int k) APSIS_PACKED {
    using N = pack<decltype(lanes)>;
    N change(0.0);
    for (const auto& p : points) change = fma(N(p.weight), N::load(p.q + k), change);
    const N here = N::load(u + k);
    for (const auto& to : targets) {
      // An increment below the margin is dropped: its rounding error, half of 4.9e-324, may exceed what it
      // leaves of a subnormal number, which would become negative.
      const N increment = N(to.beta) * change;
      const N kept = select(absolute(increment) < N(limiter::absolute_margin), N(0.0), increment);
      const N add = fma(N(to.alpha), here, kept);
      (to.fresh ? add : N::load(to.acc + k) + add).store(to.acc + k);
    }
  });
}

/// The quartic of scheme/quartic.hpp at the Gauss points and at the inner points of the Gauss–Lobatto rule,
/// minus its average. Both rules give the average, which leaves one term of the even parts.
template <class N>
struct gauss_points {
  N g0, g1, g2;
};

template <bool Limited, class N>
HWY_INLINE gauss_points<N> quartic_values(N before, N c, N after, N l, N r) {
  constexpr double outer = gauss3::outer, inner = lobatto4_inner;
  const N to_left = l - c, to_right = r - c, edges = to_left + to_right, slope = r - l;
  const N neighbours = (before - c) + (after - c), rise = after - before;
  const N middle = fma(N(-9.0 / 32.0), edges, N(1.0 / 192.0) * neighbours), even = N(-0.8) * middle;
  // ξ (1.25 − ξ²) of the slope and ξ (ξ²/2 − 1/8) of the rise.
  const N odd =
      fma(N(outer * (1.25 - outer * outer)), slope, N(outer * (0.5 * outer * outer - 0.125)) * rise);
  const N g0 = even - odd, g1 = middle, g2 = even + odd;
  gauss_points<N> values{c + g0, c + g1, c + g2};
  if constexpr (Limited) {
    const N odd_inner =
        fma(N(inner * (1.25 - inner * inner)), slope, N(inner * (0.5 * inner * inner - 0.125)) * rise);
    const N lowest_inner = fma(N(-0.1), edges, c) - absolute(odd_inner);
    const N lowest =
        minimum(minimum(minimum(l, r), minimum(values.g0, values.g1)), minimum(values.g2, lowest_inner));
    const N bound = limiter::lower_bound(c);
    if (N::any(lowest < bound)) {
      const N theta = limiter::scaling(c, lowest, bound);
      values = {fma(theta, g0, c), fma(theta, g1, c), fma(theta, g2, c)};
    }
  }
  return values;
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
