#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "apsis/scheme/row_check.cpp"
#include <hwy/foreach_target.h>

#include <apsis/scheme/row_check.hpp>

#include <apsis/exec/octet-inl.hpp>
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
  const octet_group eight;
  const auto sums = sum_squares(eight, u, v, n);
  return {eight.total(sums.difference), eight.total(sums.size)};
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
