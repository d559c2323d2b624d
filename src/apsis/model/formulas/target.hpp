// The formulas of model/target_rows.hpp.
#if defined(APSIS_MODEL_FORMULAS_TARGET) == defined(HWY_TARGET_TOGGLE)
#ifdef APSIS_MODEL_FORMULAS_TARGET
#undef APSIS_MODEL_FORMULAS_TARGET
#else
#define APSIS_MODEL_FORMULAS_TARGET
#endif

#include <apsis/exec/number.hpp>

APSIS_BEFORE_FORMULAS();
namespace apsis::APSIS_NUMBERS {

/// k0 + k1 c + k2 c² + k3 c³.
template <class N>
struct cubic_polynomial {
  N k0, k1, k2, k3;
  APSIS_FORMULA N operator()(N c) const { return fma(fma(fma(k3, c, k2), c, k1), c, k0); }
};

/// Raises a value to −keep f; returns whether some number was below.
template <class N>
APSIS_FORMULA bool raise(N& value, N keep, N f) {
  const N bound = negative_fma(keep, f, N(0.0));
  const bool raised = any<N>(value < bound);
  value = larger(value, bound);
  return raised;
}

/// Σ f c^k, k = 0 … 3.
template <class N>
struct sums_of_powers {
  N s0, s1, s2, s3;

  APSIS_FORMULA sums_of_powers() : s0(0.0), s1(0.0), s2(0.0), s3(0.0) {}
  APSIS_FORMULA sums_of_powers(N zeroth, N first, N second, N third)
      : s0(zeroth), s1(first), s2(second), s3(third) {}
  APSIS_FORMULA void add(N f, N c) {
    const N f1 = f * c, f2 = f1 * c;
    s0 = s0 + f;
    s1 = s1 + f1;
    s2 = s2 + f2;
    s3 = fma(f2, c, s3);
  }
  /// The same with a product that rounds: for points behind the last whole vector.
  APSIS_FORMULA void add_last(N f, N c) {
    const N f1 = f * c, f2 = f1 * c;
    s0 = s0 + f;
    s1 = s1 + f1;
    s2 = s2 + f2;
    s3 = s3 + f2 * c;
  }
};

}  // namespace apsis::APSIS_NUMBERS
APSIS_AFTER_FORMULAS();

#endif
