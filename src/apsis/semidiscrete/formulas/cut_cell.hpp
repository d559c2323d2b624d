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

/// Largest ratio of the terms of a correction to the value.
inline constexpr double largest_terms = 50.0;

/// Least leaving value of a steady state, as a part of the value of the cell. If a leaving value were 0 and
/// the value of the cell grew, the outflow would not grow with it, and the steady iteration would not
/// converge.
inline constexpr double least_leaving_part = 0.25;

/// Measures of the corrections of a cut cell. `size` is the largest sum of the sizes of their terms. The
/// others belong to the faces and walls through which a component leaves: its outflow in a step, the sum of
/// the corrections that increase the outflow, and the largest one that decreases it.
template <class N>
struct cut_demand {
  N size, outflow, increase, decrease;

  /// Adds a face or wall through which the fraction `leaving` > 0 of the cell leaves in a step. Adds nothing
  /// if the component enters.
  APSIS_FORMULA void add(N leaving, N correction, N size_of_terms) {
    const N share = maximum(leaving, N(0.0));
    const N counted = select(leaving > N(0.0), correction, N(0.0));
    size = maximum(size, size_of_terms);
    outflow = outflow + share;
    increase = fma(share, maximum(counted, N(0.0)), increase);
    decrease = maximum(decrease, N(0.0) - counted);
  }

  /// Returns the factor ϑ ∈ [0, 1] of the corrections with which at most the value u leaves in a step.
  /// Leaving values are at least 0 (nonnegative_leaving_value()). `kept` is the fraction of u that transport
  /// may take. Returns 0 for NaN and for negative u.
  APSIS_FORMULA N factor(N u, N kept) const {
    const N theta = factor_within(u, kept - outflow);
    return select(theta > N(0.0), theta, N(0.0));
  }

  /// Returns the factor ϑ ∈ [0, 1] for a steady state. The corrections add at most `more` times the outflow
  /// of the value u, and leaving values are at least least_leaving_part u. Returns 0 for NaN and for negative
  /// u.
  APSIS_FORMULA N steady_factor(N u, N more) const {
    const N theta = factor_within(u, more * outflow);
    const N most = N(1.0 - least_leaving_part) * u, demanded = theta * decrease;
    const N lower = select(demanded > most, theta * (most / demanded), theta);
    return select(lower > N(0.0), lower, N(0.0));
  }

 private:
  /// Returns the largest factor with which the corrections increase the outflow by at most `more` u.
  APSIS_FORMULA N factor_within(N u, N more) const {
    const N margin = N(1.0 - apsis::limiter::relative_margin);
    // Terms that cancel leave rounding errors proportional to their size. These must stay below the margin.
    const N most = N(largest_terms) * u;
    const N by_size = select(size > most, most / size, N(1.0));
    const N allowed = maximum(more * u * margin - N(apsis::limiter::absolute_margin), N(0.0));
    const N demanded = increase * by_size;
    return select(demanded > allowed, by_size * (allowed / demanded), by_size);
  }
};

/// Returns the leaving value of a cut cell: 0 if the value of the cell is negligible, as in whole cells.
template <class N>
APSIS_FORMULA N leaving_value(N u, N correction) {
  return select(absolute(u) < N(apsis::limiter::negligible), N(0.0), u + correction);
}

/// Does the same with a limiter: the result is nonnegative unless the value of the cell is negative.
template <class N>
APSIS_FORMULA N nonnegative_leaving_value(N u, N correction) {
  const N value = leaving_value(u, correction);
  return select(u > N(0.0), maximum(value, N(0.0)), value);
}

/// Returns α u + β rate of a target, plus its content old() unless it is fresh. old() is called only if it is
/// needed.
template <class N, class Old>
APSIS_FORMULA N with_rate(N u, N rate, N alpha, N beta, bool fresh, const Old& old) {
  const N own = fma(beta, rate, alpha * u);
  return fresh ? own : old() + own;
}

}  // namespace apsis::APSIS_NUMBERS
APSIS_AFTER_FORMULAS();

#endif
