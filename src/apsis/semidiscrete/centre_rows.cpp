#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "apsis/semidiscrete/centre_rows.cpp"
#include <hwy/foreach_target.h>

#include <apsis/semidiscrete/centre_rows.hpp>

#include <apsis/exec/counted.hpp>
#include <apsis/exec/simd-inl.hpp>

HWY_BEFORE_NAMESPACE();
namespace apsis::HWY_NAMESPACE {

/// A ρ^k.
constexpr double weights[] = {0.0,
                              -0.0498962651136544960533352,
                              0.00227271749006668625943531,
                              -0.000103519667812601654241598,
                              4.71520181055013387984795e-06,
                              -2.14772019501291115056886e-07,
                              9.78261847827065140353490e-09};

/// Row i of the stencil is at(i), i = −3 … 3.
template <class N, class At>
HWY_INLINE N value(const At& at, bool limited) {
  const N here = at(0);
  N change(0.0);
  // The smallest terms first, and both sides together: mirrored data give mirrored bits.
  for (int k = centre_rows::reach; k > 0; --k)
    change = fma(N(weights[k]), (at(-k) - here) + (at(k) - here), change);
  const N all = here + change;
  return limited ? maximum(all, N(0.5) * here) : all;
}

/// Flux between two cells.
template <class N>
HWY_INLINE N flux(N d, N d_after, N b, N b_after, bool limited) {
  const N all = N(1.0 / 24.0) * (d_after - d);
  return limited ? maximum(minimum(all, N(0.5) * b_after), N(-0.5) * b) : all;
}

/// Numbers of three cells.
template <class N>
struct triple {
  N before, here, after;
};

template <class N>
HWY_INLINE N average(const triple<N>& u, const triple<N>& d, bool limited) {
  const N here = u.here + d.here, before = u.before + d.before, after = u.after + d.after;
  const N all =
      here + (flux(d.here, d.after, here, after, limited) - flux(d.before, d.here, before, here, limited));
  // Rounding of halves of the smallest numbers.
  return limited ? maximum(all, minimum(here, N(0.0))) : all;
}

void values(const centre_rows::stencil& averages, bool limited, int width, double* points) {
  for_packs(width, [&](auto lanes, int k) APSIS_PACKED {
    using N = pack<decltype(lanes)>;
    const auto at = [&](int i) APSIS_PACKED {
      return N::load(averages[static_cast<std::size_t>(std::ptrdiff_t{i} + centre_rows::reach)] + k);
    };
    value<N>(at, limited).store(points + k);
  });
}

template <class N>
HWY_INLINE triple<N> numbers_of(const centre_rows::three& rows, int k) {
  return {N::load(rows.before + k), N::load(rows.here + k), N::load(rows.after + k)};
}

void add_averages(const centre_rows::three& u, const centre_rows::three& d, bool limited, int width,
                  double* averages) {
  for_packs(width, [&](auto lanes, int k) APSIS_PACKED {
    using N = pack<decltype(lanes)>;
    average(numbers_of<N>(u, k), numbers_of<N>(d, k), limited).store(averages + k);
  });
}

double operations() {
  const counted x(0.0);
  const triple<counted> row{x, x, x};
  return counted::operations_of([&] {
    value<counted>([&](int) { return x; }, true);
    average(row, row, true);
  });
}

}  // namespace apsis::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace apsis {
namespace {
HWY_EXPORT(values);
HWY_EXPORT(add_averages);
}  // namespace

namespace centre_rows {

void values(const stencil& averages, bool limited, int width, double* points) {
  HWY_DYNAMIC_DISPATCH(values)(averages, limited, width, points);
}

void add_averages(const three& u, const three& d, bool limited, int width, double* averages) {
  HWY_DYNAMIC_DISPATCH(add_averages)(u, d, limited, width, averages);
}

double operations() {
  static const double counted_once = HWY_NAMESPACE::operations();
  return counted_once;
}

}  // namespace centre_rows
}  // namespace apsis
#endif
