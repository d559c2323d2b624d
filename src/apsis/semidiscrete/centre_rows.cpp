#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "apsis/semidiscrete/centre_rows.cpp"
#include <hwy/foreach_target.h>

#include <apsis/semidiscrete/centre_rows.hpp>

#include <apsis/exec/counted.hpp>
#include <apsis/semidiscrete/formulas/centre.hpp>

#include <cstddef>
#include <utility>

HWY_BEFORE_NAMESPACE();
namespace apsis::HWY_NAMESPACE {

/// Computes the values of sizeof...(Row) − 12 cells together, so that neighbours share loaded rows.
template <class N, std::size_t... Row>
HWY_INLINE void values_of_some(const double* const* u, bool limited, int k, int width, double* points,
                               std::index_sequence<Row...>) {
  constexpr int cells = static_cast<int>(sizeof...(Row)) - 2 * centre_rows::reach;
  const N rows[] = {N::load(u[static_cast<std::ptrdiff_t>(Row) - centre_rows::reach] + k)...};
#pragma GCC unroll 3
  for (int i = 0; i < cells; ++i) {
    const auto at = [&](int j) APSIS_PACKED { return rows[i + j + centre_rows::reach]; };
    centre_value<N>(at, limited).store(points + i * width + k);
  }
}

void values(const double* const* u, int count, bool limited, int width, double* points) {
  constexpr int together = 3;
  for_packs(width, [&](auto lanes, int k) APSIS_PACKED {
    using N = pack<decltype(lanes)>;
    int i = 0;
    for (; i + together <= count; i += together)
      values_of_some<N>(u + i, limited, k, width, points + i * width,
                        std::make_index_sequence<together + 2 * centre_rows::reach>());
    for (; i < count; ++i)
      values_of_some<N>(u + i, limited, k, width, points + i * width,
                        std::make_index_sequence<1 + 2 * centre_rows::reach>());
  });
}

bool is_negative(const double* average, const double* d, int width) {
  bool negative = false;
  for_packs(width, [&](auto lanes, int k) APSIS_PACKED {
    using N = pack<decltype(lanes)>;
    negative |= N::any(N::load(average + k) + N::load(d + k) < N(0.0));
  });
  return negative;
}

void lower(const double* average, const double* d, bool all, int width, double* points) {
  for_packs(width, [&](auto lanes, int k) APSIS_PACKED {
    using N = pack<decltype(lanes)>;
    lowered_centre(N::load(average + k), N::load(d + k), N::load(points + k), all).store(points + k);
  });
}

void add_averages(const double* const* u, const double* const* d, int count, bool limited, int width,
                  double* averages) {
  for_packs(width, [&](auto lanes, int k) APSIS_PACKED {
    using N = pack<decltype(lanes)>;
    const auto cell = [&](int i)
                          APSIS_PACKED { return changed_cell<N>(N::load(u[i] + k), N::load(d[i] + k)); };
    changed_cell<N> here = cell(0);
    N before = centre_flux(cell(-1), here, limited);
    double* to = averages + k;
    for (int i = 0; i < count; ++i, to += width) {
      const changed_cell<N> next = cell(i + 1);
      const N after = centre_flux(here, next, limited);
      centre_average(here.b, before, after, limited).store(to);
      here = next;
      before = after;
    }
  });
}

double operations() {
  const counted x(0.0);
  return counted::operations_of([&] {
    centre_value<counted>([&](int) { return x; }, true);
    const changed_cell<counted> next(x, x);
    centre_average(x, x, centre_flux(next, next, true), true);
  });
}

}  // namespace apsis::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace apsis {
namespace {
HWY_EXPORT(values);
HWY_EXPORT(is_negative);
HWY_EXPORT(lower);
HWY_EXPORT(add_averages);
}  // namespace

namespace centre_rows {

void values(const double* const* u, int count, bool limited, int width, double* points) {
  HWY_DYNAMIC_DISPATCH(values)(u, count, limited, width, points);
}

bool is_negative(const double* average, const double* d, int width) {
  return HWY_DYNAMIC_DISPATCH(is_negative)(average, d, width);
}

void lower(const double* average, const double* d, bool all, int width, double* points) {
  HWY_DYNAMIC_DISPATCH(lower)(average, d, all, width, points);
}

void add_averages(const double* const* u, const double* const* d, int count, bool limited, int width,
                  double* averages) {
  HWY_DYNAMIC_DISPATCH(add_averages)(u, d, count, limited, width, averages);
}

double operations() {
  static const double counted_once = HWY_NAMESPACE::operations();
  return counted_once;
}

}  // namespace centre_rows
}  // namespace apsis
#endif
