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

/// Measures of the corrections of a cut cell: the lowest one, the largest sum of the sizes of their terms,
/// and sums over the faces and walls where a component leaves, of its outflow in a step and of the
/// corrections that increase it.
template <class N>
struct cut_demand {
  N lowest, size, outflow, increase;

  /// Adds a face or wall where a share `leaving` > 0 of the cell leaves in a step; nothing where it enters.
  APSIS_FORMULA void add(N leaving, N correction, N size_of_terms) {
    const N share = maximum(leaving, N(0.0));
    const N counted = select(leaving > N(0.0), correction, N(0.0));
    lowest = minimum(lowest, counted);
    size = maximum(size, size_of_terms);
    outflow = outflow + share;
    increase = fma(share, maximum(counted, N(0.0)), increase);
  }

  /// Returns the factor ϑ ∈ [0, 1] of the corrections that keeps all values that leave nonnegative, and the
  /// outflow of a step below the value u. `kept`: the share of u that transport may take. 0 for NaN.
  APSIS_FORMULA N factor(N u, N kept) const {
    const N margin = N(1.0 - apsis::limiter::relative_margin);
    // Terms that cancel leave rounding errors of their size, which must stay below the margin.
    const N most = N(largest_terms) * u;
    const N by_size = select(size > most, most / size, N(1.0)), least = lowest * by_size;
    const N by_sign = select(least < -u, by_size * (u / (-least) * margin), by_size);
    const N allowed = maximum((kept - outflow) * u * margin - N(apsis::limiter::absolute_margin), N(0.0));
    const N demanded = increase * by_sign;
    const N theta = select(demanded > allowed, by_sign * (allowed / demanded), by_sign);
    return select(theta > N(0.0), theta, N(0.0));
  }
};

/// The value of a cut cell where it leaves: none of a value that is negligible, as in whole cells.
template <class N>
APSIS_FORMULA N leaving_value(N u, N correction) {
  return select(absolute(u) < N(apsis::limiter::negligible), N(0.0), u + correction);
}

}  // namespace apsis::APSIS_NUMBERS
APSIS_AFTER_FORMULAS();

#endif
