#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "apsis/model/line_sums.cpp"
#include <hwy/foreach_target.h>

#include <apsis/model/line_sums.hpp>

#include <apsis/exec/octet-inl.hpp>
#include <apsis/model/formulas/line.hpp>

HWY_BEFORE_NAMESPACE();
namespace apsis::HWY_NAMESPACE {

using N = octet;
constexpr octet_group eight;

line_sums::values weigh(const double* x, const double* c, const double* base, int n, double beta, double tau,
                        double shift, double* w) {
  sums_of_weights<N> sums;
  for (int j = 0; j < n; j += sum_chains) {
    const N at = N::load(x + j), parabola = N::load(c + j);
    N weight = eight.first(line_weight(at, parabola, N(beta), N(tau), N(shift)), n - j);
    if (base != nullptr) weight = weight * N::load(base + j);
    weight.store(w + j);
    sums.add(weight, at, parabola);
  }
  return {eight.total(sums.mass), eight.total(sums.above), eight.total(sums.below), eight.total(sums.energy)};
}

line_sums::products multiply(const double* x, const double* c, const double* w, int n) {
  sums_of_products<N> sums;
  for (int j = 0; j < n; j += sum_chains) sums.add(N::load(w + j), N::load(x + j), N::load(c + j));
  return {eight.total(sums.above_x), eight.total(sums.above_c), eight.total(sums.below_x),
          eight.total(sums.below_c), eight.total(sums.cc)};
}

}  // namespace apsis::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace apsis {
namespace {
HWY_EXPORT(weigh);
HWY_EXPORT(multiply);
}  // namespace

line_sums::values line_sums::weigh(const double* x, const double* c, const double* base, int n, double beta,
                                   double tau, double shift, double* w) {
  return HWY_DYNAMIC_DISPATCH(weigh)(x, c, base, n, beta, tau, shift, w);
}

line_sums::products line_sums::multiply(const double* x, const double* c, const double* w, int n) {
  return HWY_DYNAMIC_DISPATCH(multiply)(x, c, w, n);
}

}  // namespace apsis
#endif
