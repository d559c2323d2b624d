// The formulas of semidiscrete/cut_rows.hpp.
#if defined(APSIS_SEMIDISCRETE_FORMULAS_CUT_CELL) == defined(HWY_TARGET_TOGGLE)
#ifdef APSIS_SEMIDISCRETE_FORMULAS_CUT_CELL
#undef APSIS_SEMIDISCRETE_FORMULAS_CUT_CELL
#else
#define APSIS_SEMIDISCRETE_FORMULAS_CUT_CELL
#endif

#include <apsis/exec/number.hpp>
#include <apsis/scheme/limiter.hpp>

APSIS_BEFORE_FORMULAS();
namespace apsis::APSIS_NUMBERS {

/// Terms of a correction are at most so many times the value.
inline constexpr double largest_terms = 50.0;

/// Measures of the corrections of a cut cell: the largest sum of the sizes of their terms, and sums over the
/// faces and walls where a component leaves, of its outflow in a step and of the corrections that increase
/// it.
template <class N>
struct cut_demand {
  N size, outflow, increase;

  /// Adds a face or wall where a share `leaving` > 0 of the cell leaves in a step; nothing where it enters.
  APSIS_FORMULA void add(N leaving, N correction, N size_of_terms) {
    const N share = maximum(leaving, N(0.0));
    const N counted = select(leaving > N(0.0), correction, N(0.0));
    size = maximum(size, size_of_terms);
    outflow = outflow + share;
    increase = fma(share, maximum(counted, N(0.0)), increase);
  }

  /// Returns the factor ϑ ∈ [0, 1] of the corrections with which a step lets out no more than the value u,
  /// where values that leave are at least 0 (nonnegative_leaving_value()). `kept`: the share of u that
  /// transport may take. 0 for NaN, and for negative u.
  APSIS_FORMULA N factor(N u, N kept) const {
    const N margin = N(1.0 - apsis::limiter::relative_margin);
    // Terms that cancel leave rounding errors of their size, which must stay below the margin.
    const N most = N(largest_terms) * u;
    const N by_size = select(size > most, most / size, N(1.0));
    const N allowed = maximum((kept - outflow) * u * margin - N(apsis::limiter::absolute_margin), N(0.0));
    const N demanded = increase * by_size;
    const N theta = select(demanded > allowed, by_size * (allowed / demanded), by_size);
    return select(theta > N(0.0), theta, N(0.0));
  }
};

/// The value of a cut cell where it leaves: none of a value that is negligible, as in whole cells.
template <class N>
APSIS_FORMULA N leaving_value(N u, N correction) {
  return select(absolute(u) < N(apsis::limiter::negligible), N(0.0), u + correction);
}

/// The same with a limiter: not negative, unless the value of the cell is.
template <class N>
APSIS_FORMULA N nonnegative_leaving_value(N u, N correction) {
  const N value = leaving_value(u, correction);
  return select(u > N(0.0), maximum(value, N(0.0)), value);
}

}  // namespace apsis::APSIS_NUMBERS
APSIS_AFTER_FORMULAS();

#endif
