#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "apsis/model/line_powers.cpp"
#include <hwy/foreach_target.h>

#include <apsis/model/line_powers.hpp>

#include <apsis/model/formulas/line.hpp>

#include <algorithm>
#include <cstddef>

HWY_BEFORE_NAMESPACE();
namespace apsis::HWY_NAMESPACE {

using N = pack<wide>;
constexpr int lanes = static_cast<int>(hn::MaxLanes(wide())), vectors = vectors_of_chains;

/// Adds the weights next(k, count, c) of vector k; `count` of its numbers belong to the line.
template <class Next>
HWY_INLINE line_powers::sums sum_of(const line_powers::points& line, double u, const Next& next) {
  sums_of_six_powers<N> powers[vectors];
  for (int j = 0; j < line.n; j += sum_chains)
    for (int i = 0; i < vectors; ++i) {
      const int k = j + i * lanes, count = std::max(line.n - k, 0);
      const N c = load_some(line.v + k, count) - N(u);
      N w = next(k, count, c);
      if (line.b != nullptr) w = w * load_some(line.b + k, count);
      powers[i].add(w, c);
    }
  line_powers::sums sums;
  for (int p = 0; p < static_cast<int>(sums.size()); ++p) {
    N of_vectors[vectors];
    for (int i = 0; i < vectors; ++i) of_vectors[i] = powers[i].of[p];
    sums[static_cast<std::size_t>(p)] = total_of_chains(of_vectors);
  }
  return sums;
}

line_powers::sums sum(const line_powers::points& line, double u, const double* w) {
  return sum_of(line, u, [&](int k, int count, N) APSIS_PACKED { return load_some(w + k, count); });
}

line_powers::sums change(const line_powers::points& line, double u, double beta, double gamma, double* w) {
  return sum_of(line, u, [&](int k, int count, N c) APSIS_PACKED {
    const N changed = changed_weight(load_some(w + k, count), c, N(beta), N(gamma));
    store_some(changed, count, w + k);
    return changed;  // 0 behind the line, as the weights loaded there
  });
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
