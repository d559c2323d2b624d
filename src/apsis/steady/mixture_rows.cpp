#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "apsis/steady/mixture_rows.cpp"
#include <hwy/foreach_target.h>

#include <apsis/steady/mixture_rows.hpp>

#include <apsis/steady/formulas/mixture.hpp>

#include <algorithm>

HWY_BEFORE_NAMESPACE();
namespace apsis::HWY_NAMESPACE {

using mixture_rows::weighted_differences;

void move(std::size_t first, std::size_t count, const weighted_differences& last, double last_factor,
          double* newest, const weighted_differences& now, double factor, const double* delta, double* x) {
  using N = pack<wide>;
  const std::size_t length = hn::Lanes(wide());
  const N inverse(1.0 / last_factor), scale(factor);
  const std::size_t recalled = last.theta.size(), taken = now.theta.size();
  for (std::size_t k = first; k < first + count; k += length) {
    const int some = static_cast<int>(std::min(length, first + count - k));
    image_mixture<N> mixture(load_some(x + k, some), load_some(delta + k, some), inverse);
    if (newest != nullptr) {
      for (std::size_t j = 0; j < recalled; ++j)
        mixture.recall(N(last.theta[j]), load_some(last.rows[j] + k, some));
      store_some(mixture.difference(), some, newest + k);
    }
    for (std::size_t j = 0; j < taken; ++j)
      mixture.take_off(N(now.theta[j]), load_some(now.rows[j] + k, some));
    store_some(scale * mixture.mixed, some, x + k);
  }
}

}  // namespace apsis::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace apsis {
namespace {
HWY_EXPORT(move);
}  // namespace

void mixture_rows::move(std::size_t first, std::size_t count, const weighted_differences& last,
                        double last_factor, double* newest, const weighted_differences& now, double factor,
                        const double* delta, double* x) {
  HWY_DYNAMIC_DISPATCH(move)(first, count, last, last_factor, newest, now, factor, delta, x);
}

}  // namespace apsis
#endif
