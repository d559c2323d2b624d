#if defined(APSIS_SCHEME_FORMULAS_ROW) == defined(HWY_TARGET_TOGGLE)
#ifdef APSIS_SCHEME_FORMULAS_ROW
#undef APSIS_SCHEME_FORMULAS_ROW
#else
#define APSIS_SCHEME_FORMULAS_ROW
#endif

#include <apsis/exec/number.hpp>

APSIS_BEFORE_FORMULAS();
namespace apsis::APSIS_NUMBERS {

/// The contents of a row of numbers that a check looks at.
template <class N>
struct row_contents {
  N lowest;      ///< the smallest number so far
  N negative;    ///< how many are negative
  N not_finite;  ///< 0, and NaN as soon as one is not finite: x − x

  /// Without numbers `least` is infinite.
  APSIS_FORMULA row_contents(N least, N below_zero, N differences)
      : lowest(least), negative(below_zero), not_finite(differences) {}

  APSIS_FORMULA void add(N x) {
    lowest = smaller(x, lowest);
    not_finite = not_finite + (x - x);
    negative = negative + select(x < N(0.0), N(1.0), N(0.0));
  }
};

/// Sums of squares of a row u beside another one.
template <class N>
struct sums_of_squares {
  N difference, size;

  APSIS_FORMULA sums_of_squares() : difference(0.0), size(0.0) {}
  APSIS_FORMULA void add(N u, N v) {
    const N d = u - v;
    difference = fma(d, d, difference);
    size = fma(u, u, size);
  }
};

}  // namespace apsis::APSIS_NUMBERS
APSIS_AFTER_FORMULAS();

#endif
