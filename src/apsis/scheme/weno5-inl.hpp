// Loops over a pencil with the formulas of scheme/formulas/weno5.hpp.
#if defined(APSIS_SPACE_WENO5_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef APSIS_SPACE_WENO5_INL_HPP
#undef APSIS_SPACE_WENO5_INL_HPP
#else
#define APSIS_SPACE_WENO5_INL_HPP
#endif

#include <apsis/exec/counted.hpp>
#include <apsis/exec/simd-inl.hpp>
#include <apsis/scheme/formulas/weno5.hpp>
#include <apsis/scheme/walk-inl.hpp>

HWY_BEFORE_NAMESPACE();
namespace apsis::HWY_NAMESPACE::weno5 {

/// Calls put(fraction, j) for cells 0 … count−1 of the walk. The formulas of a cell form a dependency chain
/// that is longer than the out-of-order window of a processor. They are split into three parts, and the parts
/// of three cells are interleaved to hide latency. Returns the sum of the sizes of the fractions.
template <class Weights, template <class> class Fraction, class Walk, class Put>
HWY_INLINE auto put_fractions(const Walk& way, const double* const* rows, int count, const Put& put) {
  using N = typename Walk::number;
  using terms = edge_terms<Weights, N>;
  const auto value = [&](int j) APSIS_PACKED { return way.load_and_prefetch(rows, j); };
  N sizes(0.0);
  const auto finish = [&](const Fraction<N>& cell, int j) APSIS_PACKED {
    sizes = sizes + cell.size();
    put(cell, j);
  };
  window<Weights, N> u(value(-2), value(-1), value(0), value(1), value(2));
  terms newest(u);
  Fraction<N> waiting(newest);
  if (count > 1) {
    u.advance(value(3));
    newest = terms(u);
  }
  for (int j = 2; j < count; ++j) {
    finish(waiting, j - 2);
    waiting = Fraction<N>(newest);
    u.advance(value(j + 2));
    newest = terms(u);
  }
  if (count > 1) {
    finish(waiting, count - 2);
    waiting = Fraction<N>(newest);
  }
  finish(waiting, count - 1);
  return sizes;
}

/// Calls put(fraction, j) like put_fractions(), for data of any size. The choice is made for each number, so
/// that an edge depends only on its own stencil.
template <class Weights, template <class> class Fraction, class Walk, class Put>
HWY_NOINLINE void put_scaled_fractions(const Walk& way, const double* const* rows, int count,
                                       const Put& put) {
  using N = typename Walk::number;
  for (int j = 0; j < count; ++j) {
    const auto value = [&](int i) APSIS_PACKED { return way.load(rows, j + i); };
    const window<Weights, N> u(value(-2), value(-1), value(0), value(1), value(2));
    Fraction<N> cell(edge_terms<Weights, N>{u});
    cell.replace_if_too_large(Fraction<N>(edge_terms<scaled<Weights>, N>(u)));
    put(cell, j);
  }
}

/// Calls put(fraction, j) for cells 0 … count−1 of the walk, and again if some fraction is too large. The
/// sum of sizes detects this with one addition per number. Scaling the indicators of all cells would take
/// eight operations.
template <class Weights, template <class> class Fraction, class Walk, class Put>
HWY_INLINE void along(const Walk& way, const double* const* rows, int count, const Put& put) {
  using N = typename Walk::number;
  const N sizes = put_fractions<Weights, Fraction>(way, rows, count, put);
  if constexpr (!Weights::of_any_size)
    if (!N::all(sizes < N(Fraction<N>::largest)))
      put_scaled_fractions<Weights, Fraction>(way, rows, count, put);
}

/// Computes both edges along a pencil with the weights of `Weights`; see reconstruction::edges
/// for the arguments.
template <class Weights>
HWY_INLINE void sweep_edges(const double* const* rows, int count, int width, double* left, double* right) {
  for_packs(width, [&](auto lanes, int k) APSIS_PACKED {
    using D = decltype(lanes);
    const walk<course::forward, D> way(count, k, nullptr);
    along<Weights, both_fractions>(way, rows, count, [&](const auto& cell, int j) APSIS_PACKED {
      pack<D> l(0.0), r(0.0);
      cell.edges(l, r);
      way.store(l, left, width, j);
      way.store(r, right, width, j);
    });
  });
}

/// Computes outflow edges; see reconstruction::outflow_edges for the arguments.
template <class Weights>
HWY_INLINE void sweep_outflow(const double* const* rows, int count, int width, const double* forward,
                              double* edge) {
  for_walks(forward, count, width, [&](const auto& way, int) APSIS_PACKED {
    along<Weights, right_fraction>(way, rows, count, [&](const auto& cell, int j) APSIS_PACKED {
      way.store(cell.edge(), edge, width, j);
    });
  });
}

/// Counts the operations per number of a long pencil.
template <class Weights>
double count_operations(bool both) {
  const counted x(0.0);
  window<Weights, counted> u(x, x, x, x, x);
  const auto add_size = [&]([[maybe_unused]] const auto& cell) {
    if constexpr (!Weights::of_any_size) static_cast<void>(x + cell.size());
  };
  return counted::operations_of([&] {
    u.advance(x);
    const edge_terms<Weights, counted> terms(u);
    if (both) {
      counted left(0.0), right(0.0);
      const both_fractions<counted> cell(terms);
      cell.edges(left, right);
      add_size(cell);
    } else {
      const right_fraction<counted> cell(terms);
      cell.edge();
      add_size(cell);
    }
  });
}

/// Returns the operation count, computed once; see reconstruction::operations.
template <class Weights>
double operations(bool both) {
  static const double of_one = count_operations<Weights>(false), of_both = count_operations<Weights>(true);
  return both ? of_both : of_one;
}

}  // namespace apsis::HWY_NAMESPACE::weno5
HWY_AFTER_NAMESPACE();

#endif
