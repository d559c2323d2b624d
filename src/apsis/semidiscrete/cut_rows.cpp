#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "apsis/semidiscrete/cut_rows.cpp"
#include <hwy/foreach_target.h>

#include <apsis/semidiscrete/cut_rows.hpp>

#include <apsis/semidiscrete/formulas/cut_cell.hpp>

#include <array>
#include <cstddef>
#include <span>
#include <type_traits>

HWY_BEFORE_NAMESPACE();
namespace apsis::HWY_NAMESPACE {

using cut_rows::crossing;
using cut_rows::gradient;
using cut_rows::line_bounds;
using cut_rows::neighbour;
using cut_rows::outlet;

using cut_rows::extent;
using cut_rows::line;
using cut_rows::way_out;

/// Returns the leaving part of some components. Its sign does not depend on the rate.
template <class N>
HWY_INLINE N leaving_share(const way_out& way, int directions, int k) {
  N sum = N::load(way.speeds[0] + k) * N(way.normal[0]);
  for (std::size_t d = 1; d < static_cast<std::size_t>(directions); ++d)
    sum = fma(N::load(way.speeds[d] + k), N(way.normal[d]), sum);
  return N(way.rate) * sum;
}

/// Returns the linear function at its point, for some components that leave.
template <class N>
HWY_INLINE N value_at(const line& of, int directions, int k) {
  N correction = N::load(of.slopes[0] + k) * N(of.vector[0]);
  for (std::size_t d = 1; d < static_cast<std::size_t>(directions); ++d)
    correction = fma(N::load(of.slopes[d] + k), N(of.vector[d]), correction);
  const N here = N::load(of.value + k);
  return of.limited ? nonnegative_leaving_value(here, correction) : leaving_value(here, correction);
}

void project(const way_out& way, const extent& of, double* outward) {
  for_packs(of.components, [&](auto lanes, int k) APSIS_PACKED {
    using N = pack<decltype(lanes)>;
    leaving_share<N>(way, of.directions, k).store(outward + k);
  });
}

/// Returns the gradient of some components.
template <std::size_t Directions, class N>
HWY_INLINE std::array<N, Directions> gradient_at(N here, std::span<const neighbour> around, int k) {
  std::array<N, Directions> sum;
  sum.fill(N(0.0));
  for (const neighbour& one : around) {
    const N difference = N::load(one.row + k) - here;
    for (std::size_t d = 0; d < Directions; ++d) sum[d] = fma(N(one.weight[d]), difference, sum[d]);
  }
  return sum;
}

/// Calls loop() with the number of directions as a compile-time constant.
template <class Loop>
HWY_INLINE void with_directions(int directions, const Loop& loop) {
  if (directions == 1) return loop(std::integral_constant<std::size_t, 1>());
  if (directions == 2) return loop(std::integral_constant<std::size_t, 2>());
  loop(std::integral_constant<std::size_t, 3>());
}

void fit(const double* u, std::span<const neighbour> around, const extent& of, const gradient& slopes) {
  with_directions(of.directions, [&](auto count) APSIS_PACKED {
    constexpr std::size_t directions = count;
    for_packs(of.components, [&](auto lanes, int k) APSIS_PACKED {
      using N = pack<decltype(lanes)>;
      const auto sum = gradient_at<directions>(N::load(u + k), around, k);
      for (std::size_t d = 0; d < directions; ++d) sum[d].store(slopes[d] + k);
    });
  });
}

/// Returns the factor of the limiter for some components.
template <std::size_t Directions, class N>
HWY_INLINE N factor_at(N here, const std::array<N, Directions>& slopes, const line_bounds& within, int k) {
  cut_demand<N> sums{N(0.0), N(0.0), N(0.0), N(0.0)};
  for (const outlet& one : within.outlets) {
    N sum(0.0), size(0.0);
    for (std::size_t d = 0; d < Directions; ++d) {
      const N term = slopes[d] * N(one.vector[d]);
      sum = sum + term;
      size = size + absolute(term);
    }
    sums.add(N(within.step) * leaving_share<N>(one.way, static_cast<int>(Directions), k), sum, size);
  }
  const N kept = N::load(within.kept + k);
  return within.steady ? sums.steady_factor(here, kept) : sums.factor(here, kept);
}

void fit_within(const double* u, std::span<const neighbour> around, const line_bounds& within,
                const extent& of, const gradient& slopes) {
  with_directions(of.directions, [&](auto count) APSIS_PACKED {
    constexpr std::size_t directions = count;
    for_packs(of.components, [&](auto lanes, int k) APSIS_PACKED {
      using N = pack<decltype(lanes)>;
      const N here = N::load(u + k);
      const auto sum = gradient_at<directions>(here, around, k);
      const N factor = factor_at<directions>(here, sum, within, k);
      for (std::size_t d = 0; d < directions; ++d) (factor * sum[d]).store(slopes[d] + k);
    });
  });
}

void leave(const double* outward, const line& here, const extent& of, double* values) {
  for_packs(of.components, [&](auto lanes, int k) APSIS_PACKED {
    using N = pack<decltype(lanes)>;
    select(N::load(outward + k) > N(0.0), value_at<N>(here, of.directions, k), N::load(values + k))
        .store(values + k);
  });
}

void leave_alone(const way_out& way, const line& here, const extent& of, double* values) {
  for_packs(of.components, [&](auto lanes, int k) APSIS_PACKED {
    using N = pack<decltype(lanes)>;
    select(leaving_share<N>(way, of.directions, k) > N(0.0), value_at<N>(here, of.directions, k), N(0.0))
        .store(values + k);
  });
}

/// Returns the values that pass through a face.
template <std::size_t Directions, class N>
HWY_INLINE N passing(const crossing& face, const line& here, N outward, int k) {
  constexpr auto directions = static_cast<int>(Directions);
  const line own{here.value, here.slopes, face.vector, here.limited};
  const N inner = value_at<N>(own, directions, k), outer = face.beyond.slopes[0] == nullptr
                                                               ? N::load(face.beyond.value + k)
                                                               : value_at<N>(face.beyond, directions, k);
  return select(outward > N(0.0), inner, outer);
}

void pass(std::span<const crossing> faces, const line& here, const extent& of, double* rate) {
  with_directions(of.directions, [&](auto count) APSIS_PACKED {
    constexpr std::size_t directions = count;
    for_packs(of.components, [&](auto lanes, int k) APSIS_PACKED {
      using N = pack<decltype(lanes)>;
      N sum = N::load(rate + k);
      for (const crossing& face : faces) {
        const N outward = leaving_share<N>(face.way, static_cast<int>(directions), k);
        sum = negative_fma(outward, passing<directions>(face, here, outward, k), sum);
      }
      sum.store(rate + k);
    });
  });
}

void take(const double* outward, const double* values, int n, double* rate) {
  for_packs(n, [&](auto lanes, int k) APSIS_PACKED {
    using N = pack<decltype(lanes)>;
    negative_fma(N::load(outward + k), N::load(values + k), N::load(rate + k)).store(rate + k);
  });
}

void add(const double* u, const double* rate, double alpha, double beta, bool fresh, int n, double* acc) {
  for_packs(n, [&](auto lanes, int k) APSIS_PACKED {
    using N = pack<decltype(lanes)>;
    with_rate(N::load(u + k), N::load(rate + k), N(alpha), N(beta), fresh, [&]() APSIS_PACKED {
      return N::load(acc + k);
    }).store(acc + k);
  });
}

}  // namespace apsis::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace apsis {
namespace {
HWY_EXPORT(project);
HWY_EXPORT(fit);
HWY_EXPORT(fit_within);
HWY_EXPORT(leave);
HWY_EXPORT(leave_alone);
HWY_EXPORT(pass);
HWY_EXPORT(take);
HWY_EXPORT(add);
}  // namespace

namespace cut_rows {

void project(const way_out& way, const extent& of, double* outward) {
  HWY_DYNAMIC_DISPATCH(project)(way, of, outward);
}

void fit(const double* u, std::span<const neighbour> around, const extent& of, const gradient& slopes) {
  HWY_DYNAMIC_DISPATCH(fit)(u, around, of, slopes);
}

void fit(const double* u, std::span<const neighbour> around, const line_bounds& within, const extent& of,
         const gradient& slopes) {
  HWY_DYNAMIC_DISPATCH(fit_within)(u, around, within, of, slopes);
}

void leave(const double* outward, const line& here, const extent& of, double* values) {
  HWY_DYNAMIC_DISPATCH(leave)(outward, here, of, values);
}

void leave_alone(const way_out& way, const line& here, const extent& of, double* values) {
  HWY_DYNAMIC_DISPATCH(leave_alone)(way, here, of, values);
}

void pass(std::span<const crossing> faces, const line& here, const extent& of, double* rate) {
  HWY_DYNAMIC_DISPATCH(pass)(faces, here, of, rate);
}

void take(const double* outward, const double* values, int n, double* rate) {
  HWY_DYNAMIC_DISPATCH(take)(outward, values, n, rate);
}

void add(const double* u, const double* rate, double alpha, double beta, bool fresh, int n, double* acc) {
  HWY_DYNAMIC_DISPATCH(add)(u, rate, alpha, beta, fresh, n, acc);
}

}  // namespace cut_rows
}  // namespace apsis
#endif
