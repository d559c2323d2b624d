#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "apsis/model/target_rows.cpp"
#include <hwy/foreach_target.h>

#include <apsis/model/target_rows.hpp>

#include <apsis/exec/simd-inl.hpp>

#include <limits>

HWY_BEFORE_NAMESPACE();
namespace apsis::HWY_NAMESPACE {

bool weigh(const double* m, const double* v, double u, const target_rows::cubic* of_lines, int lines,
           const double* f, double keep, int n, double* e) {
  bool raised = false;
  const bool bounded = keep < std::numeric_limits<double>::infinity();  // ∞ · 0 is NaN
  for (int line = 0; line < lines; ++line, m += n, f += n, e += n) {
    const target_rows::cubic p = of_lines[line];
    for_packs(n, [&](auto lanes, int k) APSIS_PACKED {
      using N = pack<decltype(lanes)>;
      const N c = N::load(v + k) - N(u);
      const N value = N::load(m + k) * fma(fma(fma(N(p.k3), c, N(p.k2)), c, N(p.k1)), c, N(p.k0));
      if (!bounded) {
        value.store(e + k);
        return;
      }
      const N bound = negative_fma(N(keep), N::load(f + k), N(0.0));
      raised = raised || N::any(value < bound);
      larger(value, bound).store(e + k);
    });
  }
  return raised;
}

void power_sums(const double* f, const double* v, double u, int lines, int n, target_rows::powers* of_lines) {
  using N = pack<wide>;
  const int length = static_cast<int>(hn::Lanes(wide()));
  const auto total = [](N x) { return hn::GetLane(hn::SumOfLanes(wide(), x.v)); };
  for (int line = 0; line < lines; ++line, f += n) {
    N s0(0.0), s1(0.0), s2(0.0), s3(0.0);
    int k = 0;
    for (; k + length <= n; k += length) {
      const N c = N::load(v + k) - N(u), f0 = N::load(f + k), f1 = f0 * c, f2 = f1 * c;
      s0 = s0 + f0;
      s1 = s1 + f1;
      s2 = s2 + f2;
      s3 = fma(f2, c, s3);
    }
    target_rows::powers sums = {total(s0), total(s1), total(s2), total(s3)};
    for (; k < n; ++k) {
      const double c = v[k] - u, f1 = f[k] * c, f2 = f1 * c;
      sums[0] += f[k];
      sums[1] += f1;
      sums[2] += f2;
      sums[3] += f2 * c;
    }
    of_lines[line] = sums;
  }
}

}  // namespace apsis::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace apsis {
namespace {
HWY_EXPORT(weigh);
HWY_EXPORT(power_sums);
}  // namespace

namespace target_rows {

bool weigh(const double* m, const double* v, double u, const cubic* of_lines, int lines, const double* f,
           double keep, int n, double* e) {
  return HWY_DYNAMIC_DISPATCH(weigh)(m, v, u, of_lines, lines, f, keep, n, e);
}

void power_sums(const double* f, const double* v, double u, int lines, int n, powers* of_lines) {
  HWY_DYNAMIC_DISPATCH(power_sums)(f, v, u, lines, n, of_lines);
}

}  // namespace target_rows
}  // namespace apsis
#endif
