#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "apsis/semidiscrete/lattice_rows.cpp"
#include <hwy/foreach_target.h>

#include <apsis/semidiscrete/lattice_rows.hpp>

#include <apsis/semidiscrete/formulas/lattice.hpp>

#include <algorithm>

HWY_BEFORE_NAMESPACE();
namespace apsis::HWY_NAMESPACE {

using N = pack<wide>;

/// Calls body(place, component, count) for all vectors of points, `count` of whose numbers are points.
template <class Body>
HWY_INLINE void for_points(const lattice_rows::layout& at, const Body& body) {
  const int length = static_cast<int>(hn::Lanes(wide())), n = at.block();
  for (int block = 0; block < at.blocks; ++block)
    for (int k = 0; k < n; k += length)
      body(at.first() + block * at.pitch() + k, block * n + k, std::min(n - k, length));
}

void lay_out(const lattice_rows::layout& at, const double* row, double* places) {
  for_points(at, [&](int place, int component, int count)
                     APSIS_PACKED { store_some(load_some(row + component, count), count, places + place); });
}

void add_differences(const lattice_rows::layout& at, const double* out, bool forward, double rate,
                     double* sum) {
  const int upstream = forward ? -at.apart : at.apart;
  for_points(at, [&](int place, int component, int count) APSIS_PACKED {
    const N difference = load_some(out + place + upstream, count) - load_some(out + place, count);
    store_some(fma(N(rate), difference, load_some(sum + component, count)), count, sum + component);
  });
}

void add(const double* change, double beta, int n, double* acc) {
  for_packs(n, [&](auto tag, int k) APSIS_PACKED {
    using P = pack<decltype(tag)>;
    with_change(P::load(acc + k), P(beta), P::load(change + k)).store(acc + k);
  });
}

}  // namespace apsis::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace apsis {
namespace {
HWY_EXPORT(lay_out);
HWY_EXPORT(add_differences);
HWY_EXPORT(add);
}  // namespace

namespace lattice_rows {

void lay_out(const layout& at, const double* row, double* places) {
  HWY_DYNAMIC_DISPATCH(lay_out)(at, row, places);
}

void clear_gaps(const layout& at, double* places) {
  for (int block = 0; block < at.blocks; ++block)
    std::fill_n(places + at.first() + block * at.pitch() + at.block(), at.first(), 0.0);
}

void clear_ends(const layout& at, bool forward, double* places) {
  const int last = forward ? at.block() - at.apart : 0;
  for (int block = 0; block < at.blocks; ++block)
    std::fill_n(places + at.first() + block * at.pitch() + last, at.apart, 0.0);
}

void add_differences(const layout& at, const double* out, bool forward, double rate, double* sum) {
  HWY_DYNAMIC_DISPATCH(add_differences)(at, out, forward, rate, sum);
}

void add(const double* change, double beta, int n, double* acc) {
  HWY_DYNAMIC_DISPATCH(add)(change, beta, n, acc);
}

}  // namespace lattice_rows
}  // namespace apsis
#endif
