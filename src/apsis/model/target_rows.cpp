#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "apsis/model/target_rows.cpp"
#include <hwy/foreach_target.h>

#include <apsis/model/target_rows.hpp>

#include <apsis/model/formulas/target.hpp>

#include <limits>

HWY_BEFORE_NAMESPACE();
namespace apsis::HWY_NAMESPACE {

bool weigh(const double* m, const double* v, double u, const target_rows::cubic* of_lines, int lines,
           const double* f, double keep, int n, double* e) {
  using N = pack<wide>;
  const int length = static_cast<int>(hn::Lanes(wide()));
  bool raised = false;
  const bool bounded = keep < std::numeric_limits<double>::infinity();  // ∞ · 0 is NaN
  for (int line = 0; line < lines; ++line, m += n, f += n, e += n) {
    const target_rows::cubic p = of_lines[line];
    const cubic_polynomial<N> of{N(p.k0), N(p.k1), N(p.k2), N(p.k3)};
    for (int k = 0; k < n; k += length) {
      const int count = n - k;
      N value = load_some(m + k, count) * of(load_some(v + k, count) - N(u));
      if (bounded) raised |= raise(value, N(keep), load_some(f + k, count));
      store_some(value, count, e + k);
    }
  }
  return raised;
}

}  // namespace apsis::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace apsis {
namespace {
HWY_EXPORT(weigh);
}  // namespace

namespace target_rows {

bool weigh(const double* m, const double* v, double u, const cubic* of_lines, int lines, const double* f,
           double keep, int n, double* e) {
  return HWY_DYNAMIC_DISPATCH(weigh)(m, v, u, of_lines, lines, f, keep, n, e);
}

}  // namespace target_rows
}  // namespace apsis
#endif
