// WENO edge values of fifth order; the loops over a pencil are in scheme/weno5-inl.hpp.
#if defined(APSIS_SCHEME_FORMULAS_WENO5) == defined(HWY_TARGET_TOGGLE)
#ifdef APSIS_SCHEME_FORMULAS_WENO5
#undef APSIS_SCHEME_FORMULAS_WENO5
#else
#define APSIS_SCHEME_FORMULAS_WENO5
#endif

#include <apsis/exec/number.hpp>

APSIS_BEFORE_FORMULAS();
namespace apsis::APSIS_NUMBERS::weno5 {

/// Fifth-order WENO edge values of a cell from the cells i−2 … i+2. Three third-order candidates at each edge
/// have the weights (linear weight) × g_k, where g_k depends on the smoothness indicators β_k (Jiang & Shu,
/// JCP 126, 1996). The linear weights at the right edge are (1, 6, 3)/10; the left edge follows by mirror
/// symmetry. All formulas use first and second differences, which neighbouring cells share. They represent an
/// edge value as the value of the cell plus a deviation.

/// A class `Weights` has
///   added          a constant that is part of every smoothness indicator, or 0;
///   of_any_size    whether the edges are correct for data of any size;
///   smoothness(u)  the positive indicators y_k of a window;
///   factors(y)     the g_k, up to a common factor.

/// The second difference s = u_{i−1} − 2u_i + u_{i+1} of a cell, and its inner smoothness indicator. With the
/// differences a and b to the neighbours, the indicator is β = ab + (4/3)s² = ((a + b)/2)² + (13/12)s², plus
/// the constant `added`.
template <class N>
struct bend {
  N second, inner;
  APSIS_FORMULA bend(N before, N after, N added)
      : second(after - before), inner(fma(N(4.0 / 3.0) * second, second, fma(before, after, added))) {}
};

/// The stencil of cells i−2 … i+2: the value u_i, the differences u_i − u_{i−1} and u_{i+1} − u_i, their
/// doubles, and the bends at i−1, i and i+1.
template <class Weights, class N>
class window {
 public:
  APSIS_FORMULA window(N a, N b, N c, N d, N e)
      : here(c),
        before(c - b),
        after(d - c),
        twice_before(before + before),
        twice_after(after + after),
        bend0(b - a, before, Weights::added),
        bend1(before, after, Weights::added),
        bend2(after, e - d, Weights::added),
        next_(d),
        last_(e),
        last_difference_(e - d) {}

  /// Moves the stencil by one cell; `value` is u_{i+2} of the new cell i.
  APSIS_FORMULA void advance(N value) {
    here = next_;
    next_ = last_;
    before = after;
    after = last_difference_;
    twice_before = twice_after;
    twice_after = after + after;
    last_difference_ = value - last_;
    bend0 = bend1;
    bend1 = bend2;
    bend2 = bend<N>(after, last_difference_, Weights::added);
    last_ = value;
  }

  N here, before, after, twice_before, twice_after;
  bend<N> bend0, bend1, bend2;

 private:
  N next_, last_, last_difference_;
};

/// The smoothness indicators β_k. The outer ones differ by 2as from the inner indicators of the
/// neighbours. Their rounding errors are at most some 20 units in the last place, because these quadratic
/// forms are definite.
template <class N>
struct smoothness {
  N s0, s1, s2;
};

template <class Weights, class N>
APSIS_FORMULA smoothness<N> indicators(const window<Weights, N>& u) {
  return {fma(u.twice_before, u.bend0.second, u.bend0.inner), u.bend1.inner,
          negative_fma(u.twice_after, u.bend2.second, u.bend2.inner)};
}

/// Scales β_k + δ by the power of two that makes the larger of the outer two about 1, and adds 1e-40.
/// Products of six of them then neither overflow nor underflow, whatever the size of the data. A power of two
/// changes no rounding. For data so small that only δ remains, all three are equal.
///
/// The inner indicator needs no comparison, because β₁ ≤ 2.67 (β₀ + β₂). Indeed, with the four differences a,
/// b, c, d of the stencil, β₁ ≤ 13 (b² + c²)/6, β₀ ≥ 13 b²/16 for any a, and β₂ ≥ 13 c²/16 for any d.
template <class N>
APSIS_FORMULA smoothness<N> scale(const smoothness<N>& s, N delta) {
  const N by = inverse_power_of_two(maximum(s.s0, s.s2) + delta), least = fma(delta, by, N(1e-40));
  return {fma(s.s0, by, least), fma(s.s1, by, least), fma(s.s2, by, least)};
}

/// Returns the indicators scaled with δ = share u², which makes a scheme scale-invariant. Variations below
/// √share times the value count as smooth, even where the first two derivatives vanish simultaneously.
template <class Weights, class N>
APSIS_FORMULA smoothness<N> relative_to_data(const window<Weights, N>& u, double share = 1e-6) {
  return scale(indicators(u), fma(share * u.here, u.here, N(1e-200)));
}

/// Base class of weights with the indicators of relative_to_data(). Such weights are correct for data of
/// any size.
struct weights_relative_to_data {
  static constexpr double added = 0.0;
  static constexpr bool of_any_size = true;

  template <class Window>
  static APSIS_FORMULA auto smoothness(const Window& u) {
    return relative_to_data(u);
  }
};

/// Factors g_k ≥ 0 up to a common factor. A ratio such as 1/y₀² is represented by y₁² y₂², with a
/// common denominator.
template <class N>
struct factors {
  N g0, g1, g2;
};

/// The weights `Weights` with scaled indicators, for data of any size.
template <class Weights>
struct scaled : Weights {
  template <class N>
  static APSIS_FORMULA weno5::smoothness<N> smoothness(const window<Weights, N>& u) {
    return scale(Weights::smoothness(u), N(0.0));
  }
};

/// The terms of a stencil that determine the edge values of its cell.
template <class Weights, class N>
struct edge_terms {
  N here, before, after, twice_before, twice_after, second0, second2;
  smoothness<N> y;

  template <class Of>
  APSIS_FORMULA edge_terms(const window<Of, N>& u)
      : here(u.here),
        before(u.before),
        after(u.after),
        twice_before(u.twice_before),
        twice_after(u.twice_after),
        second0(u.bend0.second),
        second2(u.bend2.second),
        y(Weights::smoothness(u)) {}

  /// Returns the numerator at the right edge. Twice the differences of the candidates to u_i are r₀, r₁/6 and
  /// −r₂/3, with the weights g₀, 6g₁ and 3g₂.
  APSIS_FORMULA N right(const factors<N>& g) const {
    const N r0 = fma(N(2.0 / 3.0), second0, before), r1 = fma(N(2.0), twice_after, twice_before),
            r2 = negative_fma(N(3.0), after, second2);
    return negative_fma(g.g2, r2, fma(g.g1, r1, g.g0 * r0));
  }
  /// Returns the numerator at the left edge for mirrored cells.
  APSIS_FORMULA N left(const factors<N>& g) const {
    const N l0 = fma(N(3.0), before, second0), l1 = fma(N(2.0), twice_before, twice_after),
            l2 = negative_fma(N(2.0 / 3.0), second2, after);
    return fma(g.g0, l0, fma(g.g1, l1, g.g2 * l2));
  }
};

/// The right edge u + numerator/(2 denominator) before the division. With the factors of weights_js, no
/// product overflows if the denominator is below `largest`, because |numerator| < 1e255 then.
template <class N>
struct right_fraction {
  static constexpr double largest = 1e200;
  N here, numerator, denominator;

  template <class Weights>
  APSIS_FORMULA right_fraction(const edge_terms<Weights, N>& u)
      : here(u.here), numerator(u.here), denominator(u.here) {
    const auto g = Weights::factors(u.y);
    numerator = u.right(g);
    denominator = fma(N(6.0), g.g1, fma(N(3.0), g.g2, g.g0));
  }

  APSIS_FORMULA N size() const { return denominator; }
  APSIS_FORMULA N edge() const { return fma(N(0.5), numerator / denominator, here); }

  /// Copies the members of `other` where members of this fraction may have overflowed.
  APSIS_FORMULA void replace_if_too_large(const right_fraction& other) {
    const auto fits = size() < N(largest);
    numerator = select(fits, numerator, other.numerator);
    denominator = select(fits, denominator, other.denominator);
  }
};

/// Both edges with a single division. The left edge is that of the mirrored cells; its numerator has the
/// opposite sign. The sums of weights differ by a factor of at most 3. If their product is below `largest`,
/// both are therefore below 2e150, and no numerator overflows.
template <class N>
struct both_fractions {
  static constexpr double largest = 1e300;
  N here, right, right_sum, left, left_sum, product;

  template <class Weights>
  APSIS_FORMULA both_fractions(const edge_terms<Weights, N>& u)
      : here(u.here), right(u.here), right_sum(u.here), left(u.here), left_sum(u.here), product(u.here) {
    const auto g = Weights::factors(u.y);
    right = u.right(g);
    left = u.left(g);
    const N common = fma(N(6.0), g.g1, g.g0 + g.g2);
    right_sum = fma(N(2.0), g.g2, common);
    left_sum = fma(N(2.0), g.g0, common);
    product = right_sum * left_sum;
  }

  APSIS_FORMULA N size() const { return product; }
  APSIS_FORMULA void edges(N& left_edge, N& right_edge) const {
    const N half = N(0.5) / product;
    right_edge = fma(right, left_sum * half, here);
    left_edge = negative_fma(left, right_sum * half, here);
  }

  /// Copies the members of `other` where members of these fractions may have overflowed.
  APSIS_FORMULA void replace_if_too_large(const both_fractions& other) {
    const auto fits = size() < N(largest);
    right = select(fits, right, other.right);
    right_sum = select(fits, right_sum, other.right_sum);
    left = select(fits, left, other.left);
    left_sum = select(fits, left_sum, other.left_sum);
    product = select(fits, product, other.product);
  }
};

}  // namespace apsis::APSIS_NUMBERS::weno5
APSIS_AFTER_FORMULAS();

#endif
