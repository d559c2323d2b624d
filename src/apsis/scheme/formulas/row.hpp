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

/// The sums of squares of two rows of n numbers, by eight numbers together (exec/octet-inl.hpp).
template <class Group, class N = typename Group::number>
APSIS_FORMULA sums_of_squares<N> sum_squares(const Group& group, const double* u, const double* v, int n) {
  constexpr int together = 8;
  sums_of_squares<N> sums;
  for (int k = 0; k < n; k += together) sums.add(group.load(u + k, n - k), group.load(v + k, n - k));
  return sums;
}

}  // namespace apsis::APSIS_NUMBERS
APSIS_AFTER_FORMULAS();

#endif
