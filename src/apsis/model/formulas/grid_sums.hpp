// The formulas of model/grid_sums.hpp.
#if defined(APSIS_MODEL_FORMULAS_GRID_SUMS) == defined(HWY_TARGET_TOGGLE)
#ifdef APSIS_MODEL_FORMULAS_GRID_SUMS
#undef APSIS_MODEL_FORMULAS_GRID_SUMS
#else
#define APSIS_MODEL_FORMULAS_GRID_SUMS
#endif

#include <apsis/exec/number.hpp>
#include <apsis/model/formulas/exponential.hpp>

APSIS_BEFORE_FORMULAS();
namespace apsis::APSIS_NUMBERS {

/// The sums Σ s c^p, p = 0 … 3.
template <class N>
struct sums_of_powers {
  N of[4];

  APSIS_FORMULA sums_of_powers() : of{N(0.0), N(0.0), N(0.0), N(0.0)} {}
  APSIS_FORMULA void add(N s, N c) {
    const N s1 = s * c, s2 = s1 * c;
    of[0] = of[0] + s;
    of[1] = of[1] + s1;
    of[2] = of[2] + s2;
    of[3] = fma(s2, c, of[3]);
  }
};

/// Returns log x; below the smallest normal number, the logarithm of this number.
template <class N>
APSIS_FORMULA N log_of_normal(N x) {
  return log_of(larger(x, N(0x1p-1022)));
}

/// Returns log g + degrees log(g/h).
template <class N>
APSIS_FORMULA N entropy_per_mass(N g, N h, N degrees) {
  const N log_of_g = log_of_normal(g);
  return fma(degrees, log_of_g - log_of_normal(h), log_of_g);
}

/// Returns grid_sums::entropy(), by groups of eight numbers (exec/octet-inl.hpp).
template <class Group, class N = typename Group::number>
APSIS_FORMULA double entropy_of_row(const Group& group, const double* w, const double* g, const double* h,
                                    double degrees, int n) {
  constexpr int together = 8;
  N sum(0.0);
  for (int j = 0; j < n; j += together) {
    const int count = n - j;
    const N of_g = group.load(g + j, count), of_w = w == nullptr ? N(1.0) : group.load(w + j, count);
    const N of_mass =
        h == nullptr ? log_of_normal(of_g) : entropy_per_mass(of_g, group.load(h + j, count), N(degrees));
    sum = fma(of_w * of_g, of_mass, sum);
  }
  return group.total(sum);
}

}  // namespace apsis::APSIS_NUMBERS
APSIS_AFTER_FORMULAS();

#endif
