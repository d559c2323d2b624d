#if defined(APSIS_SCHEME_FORMULAS_ROW) == defined(HWY_TARGET_TOGGLE)
#ifdef APSIS_SCHEME_FORMULAS_ROW
#undef APSIS_SCHEME_FORMULAS_ROW
#else
#define APSIS_SCHEME_FORMULAS_ROW
#endif

#include <apsis/exec/number.hpp>

APSIS_BEFORE_FORMULAS();
namespace apsis::APSIS_NUMBERS {

/// The properties of a row of numbers that a check needs.
template <class N>
struct row_contents {
  N lowest;      ///< smallest number so far
  N negative;    ///< count of negative numbers
  N not_finite;  ///< sum of x − x: 0, or NaN if a number is not finite

  /// For a row without numbers, `least` is infinite and the other arguments are 0.
  APSIS_FORMULA row_contents(N least, N below_zero, N differences)
      : lowest(least), negative(below_zero), not_finite(differences) {}

  APSIS_FORMULA void add(N x) {
    lowest = smaller(x, lowest);
    not_finite = not_finite + (x - x);
    negative = negative + select(x < N(0.0), N(1.0), N(0.0));
  }
};

/// Sums of squares of a row u and of its difference to another row v.
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

/// Returns the sums of squares of two rows of n numbers, by groups of eight numbers (exec/octet-inl.hpp).
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
