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

/// slopes·vector of some components.
template <class N>
HWY_INLINE N along(const gradient& slopes, const std::array<double, 3>& vector, int directions, int k) {
  N sum = N::load(slopes[0] + k) * N(vector[0]);
  for (int d = 1; d < directions; ++d)
    sum = fma(N::load(slopes[static_cast<std::size_t>(d)] + k), N(vector[static_cast<std::size_t>(d)]), sum);
  return sum;
}

template <class N>
HWY_INLINE cut_demand<N> demand_at(const demand_rows& demand, int k) {
  return {N::load(demand.size + k), N::load(demand.outflow + k), N::load(demand.increase + k)};
}

void project(const std::array<double, 3>& vector, double rate, const std::array<const double*, 3>& speeds,
             int directions, int n, double* outward) {
  for_packs(n, [&](auto lanes, int k) APSIS_PACKED {
    using N = pack<decltype(lanes)>;
    N sum = N::load(speeds[0] + k) * N(vector[0]);
    for (std::size_t d = 1; d < static_cast<std::size_t>(directions); ++d)
      sum = fma(N::load(speeds[d] + k), N(vector[d]), sum);
    (N(rate) * sum).store(outward + k);
  });
}

void fit(const double* u, std::span<const neighbour> around, int directions, int n, const gradient& slopes) {
  for_packs(n, [&](auto lanes, int k) APSIS_PACKED {
    using N = pack<decltype(lanes)>;
    const N here = N::load(u + k);
    std::array<N, 3> sum = {N(0.0), N(0.0), N(0.0)};
    for (const neighbour& one : around) {
      const N difference = N::load(one.row + k) - here;
      for (std::size_t d = 0; d < 3; ++d) sum[d] = fma(N(one.weight[d]), difference, sum[d]);
    }
    for (std::size_t d = 0; d < static_cast<std::size_t>(directions); ++d) sum[d].store(slopes[d] + k);
  });
}

void add_demand(const double* outward, double step, const gradient& slopes,
                const std::array<double, 3>& vector, int directions, int n, const demand_rows& demand) {
  for_packs(n, [&](auto lanes, int k) APSIS_PACKED {
    using N = pack<decltype(lanes)>;
    cut_demand<N> sums = demand_at<N>(demand, k);
    N sum(0.0), size(0.0);
    for (std::size_t d = 0; d < static_cast<std::size_t>(directions); ++d) {
      const N term = N::load(slopes[d] + k) * N(vector[d]);
      sum = sum + term;
      size = size + absolute(term);
    }
    sums.add(N(step) * N::load(outward + k), sum, size);
    sums.size.store(demand.size + k);
    sums.outflow.store(demand.outflow + k);
    sums.increase.store(demand.increase + k);
  });
}

void limit(const double* u, const demand_rows& demand, const double* kept, int directions, int n,
           const gradient& slopes) {
  for_packs(n, [&](auto lanes, int k) APSIS_PACKED {
    using N = pack<decltype(lanes)>;
    const N factor = demand_at<N>(demand, k).factor(N::load(u + k), N::load(kept + k));
    for (std::size_t d = 0; d < static_cast<std::size_t>(directions); ++d)
      (factor * N::load(slopes[d] + k)).store(slopes[d] + k);
  });
}

void leave(const double* u, const double* outward, const gradient& slopes,
           const std::array<double, 3>& vector, bool limited, int directions, int n, double* values) {
  for_packs(n, [&](auto lanes, int k) APSIS_PACKED {
    using N = pack<decltype(lanes)>;
    const N here = N::load(u + k), correction = along<N>(slopes, vector, directions, k);
    const N leaving = limited ? nonnegative_leaving_value(here, correction) : leaving_value(here, correction);
    select(N::load(outward + k) > N(0.0), leaving, N::load(values + k)).store(values + k);
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
HWY_EXPORT(take);
HWY_EXPORT(add);
}  // namespace

namespace cut_rows {

void project(const std::array<double, 3>& vector, double rate, const std::array<const double*, 3>& speeds,
             int directions, int n, double* outward) {
  HWY_DYNAMIC_DISPATCH(project)(vector, rate, speeds, directions, n, outward);
}

void fit(const double* u, std::span<const neighbour> around, int directions, int n, const gradient& slopes) {
  HWY_DYNAMIC_DISPATCH(fit)(u, around, directions, n, slopes);
}

void add_demand(const double* outward, double step, const gradient& slopes,
                const std::array<double, 3>& vector, int directions, int n, const demand_rows& demand) {
  HWY_DYNAMIC_DISPATCH(add_demand)(outward, step, slopes, vector, directions, n, demand);
}

void limit(const double* u, const demand_rows& demand, const double* kept, int directions, int n,
           const gradient& slopes) {
  HWY_DYNAMIC_DISPATCH(limit)(u, demand, kept, directions, n, slopes);
}

void leave(const double* u, const double* outward, const gradient& slopes,
           const std::array<double, 3>& vector, bool limited, int directions, int n, double* values) {
  HWY_DYNAMIC_DISPATCH(leave)(u, outward, slopes, vector, limited, directions, n, values);
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
