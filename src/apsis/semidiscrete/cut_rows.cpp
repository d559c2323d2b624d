#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "apsis/semidiscrete/cut_rows.cpp"
#include <hwy/foreach_target.h>

#include <apsis/semidiscrete/cut_rows.hpp>

#include <apsis/semidiscrete/formulas/cut_cell.hpp>

HWY_BEFORE_NAMESPACE();
namespace apsis::HWY_NAMESPACE {

using cut_rows::demand_rows;
using cut_rows::gradient;
using cut_rows::neighbour;

using cut_rows::extent;
using cut_rows::line;
using cut_rows::way_out;

/// The share of some components that leaves. The sign does not depend on the rate.
template <class N>
HWY_INLINE N leaving_share(const way_out& way, int directions, int k) {
  N sum = N::load(way.speeds[0] + k) * N(way.normal[0]);
  for (std::size_t d = 1; d < static_cast<std::size_t>(directions); ++d)
    sum = fma(N::load(way.speeds[d] + k), N(way.normal[d]), sum);
  return N(way.rate) * sum;
}

/// The line at its point, of some components that leave.
template <class N>
HWY_INLINE N value_at(const line& of, int directions, int k) {
  N correction = N::load(of.slopes[0] + k) * N(of.vector[0]);
  for (std::size_t d = 1; d < static_cast<std::size_t>(directions); ++d)
    correction = fma(N::load(of.slopes[d] + k), N(of.vector[d]), correction);
  const N here = N::load(of.value + k);
  return of.limited ? nonnegative_leaving_value(here, correction) : leaving_value(here, correction);
}

template <class N>
HWY_INLINE cut_demand<N> demand_at(const demand_rows& demand, int k) {
  return {N::load(demand.size + k), N::load(demand.outflow + k), N::load(demand.increase + k)};
}

void project(const way_out& way, const extent& of, double* outward) {
  for_packs(of.components, [&](auto lanes, int k) APSIS_PACKED {
    using N = pack<decltype(lanes)>;
    leaving_share<N>(way, of.directions, k).store(outward + k);
  });
}

void fit(const double* u, std::span<const neighbour> around, const extent& of, const gradient& slopes) {
  for_packs(of.components, [&](auto lanes, int k) APSIS_PACKED {
    using N = pack<decltype(lanes)>;
    const N here = N::load(u + k);
    std::array<N, 3> sum = {N(0.0), N(0.0), N(0.0)};
    for (const neighbour& one : around) {
      const N difference = N::load(one.row + k) - here;
      for (std::size_t d = 0; d < 3; ++d) sum[d] = fma(N(one.weight[d]), difference, sum[d]);
    }
    for (std::size_t d = 0; d < static_cast<std::size_t>(of.directions); ++d) sum[d].store(slopes[d] + k);
  });
}

void add_demand(const way_out& way, double step, const line& here, const extent& of,
                const demand_rows& demand) {
  for_packs(of.components, [&](auto lanes, int k) APSIS_PACKED {
    using N = pack<decltype(lanes)>;
    cut_demand<N> sums = demand_at<N>(demand, k);
    N sum(0.0), size(0.0);
    for (std::size_t d = 0; d < static_cast<std::size_t>(of.directions); ++d) {
      const N term = N::load(here.slopes[d] + k) * N(here.vector[d]);
      sum = sum + term;
      size = size + absolute(term);
    }
    sums.add(N(step) * leaving_share<N>(way, of.directions, k), sum, size);
    sums.size.store(demand.size + k);
    sums.outflow.store(demand.outflow + k);
    sums.increase.store(demand.increase + k);
  });
}

void limit(const double* u, const demand_rows& demand, const double* kept, const extent& of,
           const gradient& slopes) {
  for_packs(of.components, [&](auto lanes, int k) APSIS_PACKED {
    using N = pack<decltype(lanes)>;
    const N factor = demand_at<N>(demand, k).factor(N::load(u + k), N::load(kept + k));
    for (std::size_t d = 0; d < static_cast<std::size_t>(of.directions); ++d)
      (factor * N::load(slopes[d] + k)).store(slopes[d] + k);
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

/// rate ← rate − outward f, f being the line where it leaves, and beyond(lanes, k) elsewhere.
template <class Beyond>
HWY_INLINE void pass_to(const way_out& way, const line& here, const Beyond& beyond, const extent& of,
                        double* rate) {
  for_packs(of.components, [&](auto lanes, int k) APSIS_PACKED {
    using N = pack<decltype(lanes)>;
    const N outward = leaving_share<N>(way, of.directions, k);
    const N f = select(outward > N(0.0), value_at<N>(here, of.directions, k), beyond(lanes, k));
    negative_fma(outward, f, N::load(rate + k)).store(rate + k);
  });
}

void pass_to_row(const way_out& way, const line& here, const double* beyond, const extent& of, double* rate) {
  pass_to(
      way, here, [&](auto lanes, int k) APSIS_PACKED { return pack<decltype(lanes)>::load(beyond + k); }, of,
      rate);
}

void pass_to_line(const way_out& way, const line& here, const line& beyond, const extent& of, double* rate) {
  pass_to(
      way, here,
      [&](auto lanes, int k)
          APSIS_PACKED { return value_at<pack<decltype(lanes)>>(beyond, of.directions, k); },
      of, rate);
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
    const N own = fma(N(beta), N::load(rate + k), N(alpha) * N::load(u + k));
    (fresh ? own : N::load(acc + k) + own).store(acc + k);
  });
}

}  // namespace apsis::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace apsis {
namespace {
HWY_EXPORT(project);
HWY_EXPORT(fit);
HWY_EXPORT(add_demand);
HWY_EXPORT(limit);
HWY_EXPORT(leave);
HWY_EXPORT(leave_alone);
HWY_EXPORT(pass_to_row);
HWY_EXPORT(pass_to_line);
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

void add_demand(const way_out& way, double step, const line& here, const extent& of,
                const demand_rows& demand) {
  HWY_DYNAMIC_DISPATCH(add_demand)(way, step, here, of, demand);
}

void limit(const double* u, const demand_rows& demand, const double* kept, const extent& of,
           const gradient& slopes) {
  HWY_DYNAMIC_DISPATCH(limit)(u, demand, kept, of, slopes);
}

void leave(const double* outward, const line& here, const extent& of, double* values) {
  HWY_DYNAMIC_DISPATCH(leave)(outward, here, of, values);
}

void leave_alone(const way_out& way, const line& here, const extent& of, double* values) {
  HWY_DYNAMIC_DISPATCH(leave_alone)(way, here, of, values);
}

void pass(const way_out& way, const line& here, const double* beyond, const extent& of, double* rate) {
  HWY_DYNAMIC_DISPATCH(pass_to_row)(way, here, beyond, of, rate);
}

void pass(const way_out& way, const line& here, const line& beyond, const extent& of, double* rate) {
  HWY_DYNAMIC_DISPATCH(pass_to_line)(way, here, beyond, of, rate);
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
