#if defined(APSIS_SPACE_WENO5_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef APSIS_SPACE_WENO5_INL_HPP
#undef APSIS_SPACE_WENO5_INL_HPP
#else
#define APSIS_SPACE_WENO5_INL_HPP
#endif

#include <apsis/core/counted.hpp>
#include <apsis/space/walk-inl.hpp>

HWY_BEFORE_NAMESPACE();
namespace apsis::HWY_NAMESPACE::weno5 {

/// Fifth-order WENO edge values of a cell from the cells i−2 … i+2. Three third-order candidates at each edge
/// are weighted by (linear weight) × g_k, where g_k depends on the indicators of smoothness β_k (Jiang & Shu,
/// JCP 126, 1996). Right edge: linear weights (1, 6, 3)/10; left edge by mirror symmetry. Everything is
/// written with first and second differences, which neighbouring cells share, and the edge as the cell's own
/// value and a deviation.

/// u_{i−1} − 2u_i + u_{i+1}, a third of it, and 13/3 of its square.
template <class N>
struct bend {
  N second, third, square;
  HWY_INLINE bend(N before, N after)
      : second(after - before), third(N(1.0 / 3.0) * second), square(N(13.0 / 3.0) * second * second) {}
};

/// What the formulas need of the cells i−2 … i+2: the value u_i, the differences u_i − u_{i−1} and u_{i+1} −
/// u_i, and the second differences at i−1, i and i+1.
template <class N>
class window {
 public:
  HWY_INLINE window(N a, N b, N c, N d, N e)
      : here(c),
        before(c - b),
        after(d - c),
        bend0(b - a, before),
        bend1(before, after),
        bend2(after, e - d),
        next_(d),
        last_(e) {}

  /// One cell on; `value` is u_{i+2} of the new cell i.
  HWY_INLINE void advance(N value) {
    here = next_;
    next_ = last_;
    before = after;
    after = next_ - here;
    bend0 = bend1;
    bend1 = bend2;
    bend2 = bend<N>(after, value - next_);
    last_ = value;
  }

  N here, before, after;
  bend<N> bend0, bend1, bend2;

 private:
  N next_, last_;
};

/// 4β_k.
template <class N>
struct smoothness {
  N s0, s1, s2;
};

template <class N>
HWY_INLINE smoothness<N> indicators(const window<N>& u) {
  const N two(2.0), y0 = fma(two, u.before, u.bend0.second), y1 = u.before + u.after,
                    y2 = negative_fma(two, u.after, u.bend2.second);
  return {fma(y0, y0, u.bend0.square), fma(y1, y1, u.bend1.square), fma(y2, y2, u.bend2.square)};
}

/// 4(β_k + δ) times the power of two that brings the largest of them to about 1, and kept above 1e-40:
/// products of six of these neither overflow nor underflow, whatever the size of the data. Where the data are
/// so small that only δ is left, all three are equal.
template <class N>
HWY_INLINE smoothness<N> scale(const smoothness<N>& s, N delta) {
  const N by = inverse_power_of_two(maximum(maximum(s.s1, s.s2), s.s0) + delta),
          least = fma(delta, by, N(1e-40));
  return {fma(s.s0, by, least), fma(s.s1, by, least), fma(s.s2, by, least)};
}

/// What the edges of a cell need of its window.
template <class Weights, class N>
struct measured {
  N here, before, after, third0, third1, third2;
  smoothness<N> y;

  HWY_INLINE measured(const window<N>& u)
      : here(u.here),
        before(u.before),
        after(u.after),
        third0(u.bend0.third),
        third1(u.bend1.third),
        third2(u.bend2.third),
        y(scale(indicators(u), Weights::delta(u.here))) {}
};

/// g_k > 0 up to a common factor: a ratio such as 1/y₀² is written y₁² y₂², over one common denominator.
template <class N>
struct factors {
  N g0, g1, g2;
};

/// Twice the candidates minus u_i.
template <class N>
struct deviations {
  N r0, r1, r2;
};

// Additions are cheap beside multiplications, which have fewer units: hence 3g = g + g + g.
template <class Cell, class N = decltype(Cell::here)>
HWY_INLINE deviations<N> right_deviations(const Cell& u) {
  return {u.before + u.third0 + u.third0, u.after - u.third1, u.after - u.third2};
}

/// Of the left edge, in the order of the right edge of the mirrored cells; with the opposite sign.
template <class Cell, class N = decltype(Cell::here)>
HWY_INLINE deviations<N> left_deviations(const Cell& u) {
  return {u.after - u.third2 - u.third2, u.before + u.third1, u.before + u.third0};
}

template <class N>
HWY_INLINE N triple(N x) {
  return x + x + x;
}

/// An edge but for the division: u + numerator/denominator.
template <class N>
struct right_fraction {
  N here, numerator, denominator;

  template <class Weights>
  HWY_INLINE right_fraction(const measured<Weights, N>& u)
      : here(u.here), numerator(u.here), denominator(u.here) {
    const auto g = Weights::factors(u.y);
    const auto [r0, r1, r2] = right_deviations(u);
    const N half_middle = triple(g.g1), middle = half_middle + half_middle, far = triple(g.g2);
    numerator = fma(far, r2, fma(middle, r1, g.g0 * r0));
    denominator = g.g0 + middle + far;
  }

  HWY_INLINE N edge() const { return here + numerator / (denominator + denominator); }
};

/// Both edges with one division.
template <class N>
struct both_fractions {
  N here, right, right_sum, left, left_sum;

  template <class Weights>
  HWY_INLINE both_fractions(const measured<Weights, N>& u)
      : here(u.here), right(u.here), right_sum(u.here), left(u.here), left_sum(u.here) {
    const auto g = Weights::factors(u.y);
    const auto [r0, r1, r2] = right_deviations(u);
    const auto [l0, l1, l2] = left_deviations(u);
    const N half_middle = triple(g.g1), middle = half_middle + half_middle;
    const N right_far = triple(g.g2), left_far = triple(g.g0);
    right_sum = g.g0 + middle + right_far;
    left_sum = left_far + middle + g.g2;
    right = fma(right_far, r2, fma(middle, r1, g.g0 * r0));
    left = fma(left_far, l2, fma(middle, l1, g.g2 * l0));
  }

  HWY_INLINE void edges(N& left_edge, N& right_edge) const {
    const N half = N(0.5) / (right_sum * left_sum);
    right_edge = fma(right, left_sum * half, here);
    left_edge = negative_fma(left, right_sum * half, here);
  }
};

/// Calls put(fraction, j) for cells 0 … count−1 of the walk. The formulas of a cell are one long chain,
/// longer than a processor looks ahead; so they are cut in three, and those of three cells are under way at a
/// time.
template <class Weights, template <class> class Fraction, class Walk, class Put>
HWY_INLINE void along(const Walk& way, const double* const* rows, int count, const Put& put) {
  using N = typename Walk::number;
  window<N> u(way.load(rows, -2), way.load(rows, -1), way.load(rows, 0), way.load(rows, 1),
              way.load(rows, 2));
  measured<Weights, N> newest(u);
  Fraction<N> waiting(newest);
  if (count > 1) {
    u.advance(way.load(rows, 3));
    newest = measured<Weights, N>(u);
  }
  for (int j = 2; j < count; ++j) {
    put(waiting, j - 2);
    waiting = Fraction<N>(newest);
    u.advance(way.load(rows, j + 2));
    newest = measured<Weights, N>(u);
  }
  if (count > 1) {
    put(waiting, count - 2);
    waiting = Fraction<N>(newest);
  }
  put(waiting, count - 1);
}

/// Applies `Weights::factors(window) → factors` along a pencil; see reconstruction::edges for the arguments.
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

/// The same for reconstruction::outflow_edges.
template <class Weights>
HWY_INLINE void sweep_outflow(const double* const* rows, int count, int width, const double* forward,
                              double* edge) {
  for_walks(forward, count, width, [&](const auto& way, int) APSIS_PACKED {
    along<Weights, right_fraction>(way, rows, count, [&](const auto& cell, int j) APSIS_PACKED {
      way.store(cell.edge(), edge, width, j);
    });
  });
}

/// Operations for one number of a long pencil.
template <class Weights>
double count_operations(bool both) {
  const counted x(0.0);
  window<counted> u(x, x, x, x, x);
  return counted::operations_of([&] {
    counted left(0.0), right(0.0);
    u.advance(x);
    if (both) {
      both_fractions<counted>(measured<Weights, counted>(u)).edges(left, right);
    } else {
      right_fraction<counted>(measured<Weights, counted>(u)).edge();
    }
  });
}

/// The same, counted once; see reconstruction::operations.
template <class Weights>
double operations(bool both) {
  static const double of_one = count_operations<Weights>(false), of_both = count_operations<Weights>(true);
  return both ? of_both : of_one;
}

}  // namespace apsis::HWY_NAMESPACE::weno5
HWY_AFTER_NAMESPACE();

#endif
