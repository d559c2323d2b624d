#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "apsis/semidiscrete/lattice_rows.cpp"
#include <hwy/foreach_target.h>

#include <apsis/semidiscrete/lattice_rows.hpp>

#include <apsis/semidiscrete/formulas/lattice.hpp>
#include <apsis/semidiscrete/formulas/upwind.hpp>

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

/// Calls body(place) for vectors of all places, those of gaps included, which costs less than masks.
template <class Body>
HWY_INLINE void for_places(const lattice_rows::layout& at, const Body& body) {
  const int length = static_cast<int>(hn::Lanes(wide())), first = at.first(), end = first + at.lanes();
  for (int place = first; place < end; place += length) body(place);
}

void find_edges(const lattice_rows::layout& at, const lattice_rows::flux_rule& rule,
                const lattice_rows::places& to) {
  const int downstream = rule.forward ? at.apart : -at.apart;
  const double* values = to.values;
  double *edges = to.edges, *low_order = to.low_order;
  for_places(at, [=](int place) APSIS_PACKED {
    const auto value = [=](int i) APSIS_PACKED { return N::load(values + place + i * downstream); };
    const N here = value(0), low = upwind1_edge(here);
    low.store(low_order + place);
    (rule.fifth_order ? upwind5_edge(value(-2), value(-1), here, value(1), value(2)) : low)
        .store(edges + place);
  });
}

void limit_edges_along(const lattice_rows::layout& at, const lattice_rows::flux_rule& rule,
                       const lattice_rows::places& to) {
  const int downstream = rule.forward ? at.apart : -at.apart;
  const double *values = to.values, *edges = to.edges, *low_order = to.low_order;
  double *fractions = to.fractions, *out = to.limited_out;
  const N inverse_cfl(rule.inverse_cfl);
  for_places(at, [=](int place) APSIS_PACKED {
    const int before = place - downstream;
    const N low_up = N::load(low_order + before), low = N::load(low_order + place);
    limited_fraction(low_up, low, N::load(values + place), N::load(edges + before) - low_up,
                     N::load(edges + place) - low, inverse_cfl)
        .store(fractions + place);
  });
  for_places(at, [=](int place) APSIS_PACKED {
    const N low = N::load(low_order + place), edge = N::load(edges + place);
    limited_edge(low, edge, N::load(fractions + place), N::load(fractions + place + downstream))
        .store(out + place);
  });
}

/// Sets `count` numbers from a place of every block on to 0.
HWY_INLINE void clear(const lattice_rows::layout& at, int from, int count, double* places) {
  const int length = static_cast<int>(hn::Lanes(wide()));
  for (int block = 0; block < at.blocks; ++block)
    for (int k = 0; k < count; k += length)
      store_some(N(0.0), count - k, places + at.first() + block * at.pitch() + from + k);
}

void find_fluxes(const lattice_rows::layout& at, const lattice_rows::flux_rule& rule, const double* row,
                 const lattice_rows::places& to) {
  for_points(at, [&](int place, int component, int count) APSIS_PACKED {
    store_some(load_some(row + component, count), count, to.values + place);
  });
  find_edges(at, rule, to);
  clear(at, at.block(), at.first(), to.edges);  // gaps have no points
  if (rule.limited) limit_edges_along(at, rule, to);
  clear(at, rule.forward ? at.block() - at.apart : 0, at.apart, to.fluxes(rule));
}

void add_differences(const lattice_rows::layout& at, const double* out, bool forward, double rate, bool fresh,
                     double* sum) {
  const int upstream = forward ? -at.apart : at.apart;
  for_points(at, [&](int place, int component, int count) APSIS_PACKED {
    const N difference = load_some(out + place + upstream, count) - load_some(out + place, count);
    const N before = fresh ? N(0.0) : load_some(sum + component, count);
    store_some(fma(N(rate), difference, before), count, sum + component);
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
HWY_EXPORT(find_fluxes);
HWY_EXPORT(add_differences);
HWY_EXPORT(add);
}  // namespace

namespace lattice_rows {

void find_fluxes(const layout& at, const flux_rule& rule, const double* row, const places& to) {
  HWY_DYNAMIC_DISPATCH(find_fluxes)(at, rule, row, to);
}

void add_differences(const layout& at, const double* out, bool forward, double rate, bool fresh,
                     double* sum) {
  HWY_DYNAMIC_DISPATCH(add_differences)(at, out, forward, rate, fresh, sum);
}

void add(const double* change, double beta, int n, double* acc) {
  HWY_DYNAMIC_DISPATCH(add)(change, beta, n, acc);
}

}  // namespace lattice_rows
}  // namespace apsis
#endif
