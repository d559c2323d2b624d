#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "apsis/model/line_powers.cpp"
#include <hwy/foreach_target.h>

#include <apsis/model/line_powers.hpp>

#include <apsis/exec/octet-inl.hpp>
#include <apsis/model/formulas/velocity_line.hpp>

#include <cstddef>

HWY_BEFORE_NAMESPACE();
namespace apsis::HWY_NAMESPACE {

constexpr octet_group eight;

template <class Weights>
HWY_INLINE line_powers::sums sum_of(const line_powers::points& line, double u, const Weights& weights) {
  const auto powers = powers_on_line<sums_of_six_powers<octet>>(eight, {line.n, line.v, line.b}, u, weights);
  line_powers::sums sums;
  for (std::size_t p = 0; p < sums.size(); ++p) sums[p] = eight.total(powers.of[p]);
  return sums;
}

line_powers::sums sum(const line_powers::points& line, double u, const double* w) {
  return sum_of(line, u, row_of_line<octet_group>{eight, w});
}

line_powers::sums change(const line_powers::points& line, double u, double beta, double gamma, double* w) {
  return sum_of(line, u, changed_row_of_line<octet_group>{eight, w, beta, gamma});
}

}  // namespace apsis::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace apsis {
namespace {
HWY_EXPORT(sum);
HWY_EXPORT(change);
}  // namespace

line_powers::sums line_powers::sum(const points& line, double u, const double* w) {
  return HWY_DYNAMIC_DISPATCH(sum)(line, u, w);
}

line_powers::sums line_powers::change(const points& line, double u, double beta, double gamma, double* w) {
  return HWY_DYNAMIC_DISPATCH(change)(line, u, beta, gamma, w);
}

}  // namespace apsis
#endif
