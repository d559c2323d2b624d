#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "apsis/scheme/row_check.cpp"
#include <hwy/foreach_target.h>

#include <apsis/scheme/row_check.hpp>

#include <apsis/exec/simd-inl.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

HWY_BEFORE_NAMESPACE();
namespace apsis::HWY_NAMESPACE {

row_extremes extremes(const double* row, int n) {
  const wide lanes;
  using N = pack<wide>;
  const int length = static_cast<int>(hn::Lanes(lanes));
  // The initial minimum is +infinity; the sum of x − x is NaN as soon as one x is not finite.
  N lowest(std::numeric_limits<double>::infinity()), none(0.0), negative(0.0);
  int k = 0;
  for (; k + length <= n; k += length) {
    const N x = N::load(row + k);
    lowest = smaller(x, lowest);
    none = none + (x - x);
    negative = negative + select(x < N(0.0), N(1.0), N(0.0));
  }
  row_extremes found{hn::GetLane(hn::MinOfLanes(lanes, lowest.v)),
                     static_cast<long>(hn::GetLane(hn::SumOfLanes(lanes, negative.v)))};
  double not_finite = hn::GetLane(hn::SumOfLanes(lanes, none.v));
  for (; k < n; ++k) {
    found.lowest = std::min(found.lowest, row[k]);
    found.negative += row[k] < 0.0 ? 1 : 0;
    not_finite += row[k] - row[k];
  }
  if (std::isnan(not_finite)) found.lowest = std::numeric_limits<double>::quiet_NaN();
  return found;
}

}  // namespace apsis::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace apsis {
namespace {
HWY_EXPORT(extremes);
}

row_extremes compute_extremes(const double* row, int n) {
  return HWY_DYNAMIC_DISPATCH(extremes)(row, n);
}

}  // namespace apsis
#endif
