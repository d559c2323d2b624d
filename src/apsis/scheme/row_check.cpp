#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "apsis/scheme/row_check.cpp"
#include <hwy/foreach_target.h>

#include <apsis/scheme/row_check.hpp>

#include <apsis/scheme/formulas/row.hpp>

#include <cmath>
#include <limits>

HWY_BEFORE_NAMESPACE();
namespace apsis::HWY_NAMESPACE {

row_extremes extremes(const double* row, int n) {
  const wide lanes;
  const int length = static_cast<int>(hn::Lanes(lanes));
  row_contents<pack<wide>> packed(std::numeric_limits<double>::infinity(), 0.0, 0.0);
  int k = 0;
  for (; k + length <= n; k += length) packed.add(pack<wide>::load(row + k));
  using one = pack<narrow>;
  row_contents<one> all{hn::GetLane(hn::MinOfLanes(lanes, packed.lowest.v)),
                        hn::GetLane(hn::SumOfLanes(lanes, packed.negative.v)),
                        hn::GetLane(hn::SumOfLanes(lanes, packed.not_finite.v))};
  for (; k < n; ++k) all.add(one::load(row + k));
  const bool finite = !std::isnan(hn::GetLane(all.not_finite.v));
  return {finite ? hn::GetLane(all.lowest.v) : std::numeric_limits<double>::quiet_NaN(),
          static_cast<long>(hn::GetLane(all.negative.v))};
}

row_squares squares(const double* u, const double* v, int n) {
  constexpr int lanes = static_cast<int>(hn::MaxLanes(wide()));
  using N = pack<wide>;
  sums_of_squares<N> sums[vectors_of_chains];
  for (int k = 0; k < n; k += sum_chains)
    for (int i = 0; i < vectors_of_chains && k + i * lanes < n; ++i) {
      const int at = k + i * lanes;
      sums[i].add(load_some(u + at, n - at), load_some(v + at, n - at));
    }
  N difference[vectors_of_chains], size[vectors_of_chains];
  for (int i = 0; i < vectors_of_chains; ++i) {
    difference[i] = sums[i].difference;
    size[i] = sums[i].size;
  }
  return {total_of_chains(difference), total_of_chains(size)};
}

}  // namespace apsis::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace apsis {
namespace {
HWY_EXPORT(extremes);
HWY_EXPORT(squares);
}  // namespace

row_extremes compute_extremes(const double* row, int n) {
  return HWY_DYNAMIC_DISPATCH(extremes)(row, n);
}

row_squares compute_squares(const double* u, const double* v, int n) {
  return HWY_DYNAMIC_DISPATCH(squares)(u, v, n);
}

}  // namespace apsis
#endif
