#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "apsis/model/plane_rows.cpp"
#include <hwy/foreach_target.h>

#include <apsis/model/plane_rows.hpp>

#include <apsis/exec/octet-inl.hpp>
#include <apsis/model/formulas/plane.hpp>

#include <cstddef>

HWY_BEFORE_NAMESPACE();
namespace apsis::HWY_NAMESPACE {

void fill(const plane_walk& of, const double* v, int n, double* m) {
  constexpr octet_group eight;
  walk_over_rows(eight, of, v, n, [&](int row, int j, const octet& values) APSIS_PACKED {
    double* const to = m + static_cast<std::ptrdiff_t>(row) * n + j;
    if (j + octet_length <= n)
      eight.store(values, to);
    else
      eight.store(values, n - j, to);
  });
}

void multiply(const plane_rows::tables& of, double* m) {
  using N = pack<wide>;
  const int length = static_cast<int>(hn::Lanes(wide())), lines = of.n[1], last = of.n[2];
  const std::ptrdiff_t size = static_cast<std::ptrdiff_t>(lines) * last;
  for (int i = 0; i < of.n[0]; ++i, m += size) {
    const double *factor = of.of_01 + static_cast<std::ptrdiff_t>(i) * lines,
                 *first = of.of_02 + static_cast<std::ptrdiff_t>(i) * last;
    int k = 0;
    for (; k + length <= last; k += length) {
      const N x = N::load(first + k);
      for (int j = 0; j < lines; ++j) {
        const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(j) * last + k;
        (N(factor[j]) * x * N::load(of.of_12 + at)).store(m + at);
      }
    }
    if (const int count = last - k; count > 0) {
      const N x = load_some(first + k, count);
      for (int j = 0; j < lines; ++j) {
        const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(j) * last + k;
        store_some(N(factor[j]) * x * load_some(of.of_12 + at, count), count, m + at);
      }
    }
  }
}

}  // namespace apsis::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace apsis {
namespace {
HWY_EXPORT(fill);
HWY_EXPORT(multiply);
}  // namespace

void plane_rows::fill(const plane_walk& of, const double* v, int n, double* m) {
  HWY_DYNAMIC_DISPATCH(fill)(of, v, n, m);
}

void plane_rows::multiply(const tables& of, double* m) {
  HWY_DYNAMIC_DISPATCH(multiply)(of, m);
}

}  // namespace apsis
#endif
