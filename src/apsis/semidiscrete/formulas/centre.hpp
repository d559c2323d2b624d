// The formulas of semidiscrete/centre_rows.hpp.
#if defined(APSIS_SEMIDISCRETE_FORMULAS_CENTRE) == defined(HWY_TARGET_TOGGLE)
#ifdef APSIS_SEMIDISCRETE_FORMULAS_CENTRE
#undef APSIS_SEMIDISCRETE_FORMULAS_CENTRE
#else
#define APSIS_SEMIDISCRETE_FORMULAS_CENTRE
#endif

#include <apsis/exec/number.hpp>
#include <apsis/semidiscrete/centre_rows.hpp>

APSIS_BEFORE_FORMULAS();
namespace apsis::APSIS_NUMBERS {

/// The weights A ρ^k.
constexpr double centre_weights[] = {0.0,
                                     -0.0498962651136544960533352,
                                     0.00227271749006668625943531,
                                     -0.000103519667812601654241598,
                                     4.71520181055013387984795e-06,
                                     -2.14772019501291115056886e-07,
                                     9.78261847827065140353490e-09};

/// Returns the value at a centre. Row i of the stencil is at(i), i = −6 … 6.
template <class N, class At>
APSIS_FORMULA N centre_value(const At& at, bool limited) {
  const N here = at(0), twice = here + here;
  N change(0.0);
  // Adds the smallest terms first, and both sides together, so that mirrored data give mirrored bits.
#pragma GCC unroll 6
  for (int k = apsis::centre_rows::reach; k > 0; --k)
    change = fma(N(centre_weights[k]), (at(-k) + at(k)) - twice, change);
  const N all = here + change;
  return limited ? maximum(all, N(0.5) * here) : all;
}

/// A cell with the change d of its point value and b = u + d.
template <class N>
struct changed_cell {
  N d, b, half;
  APSIS_FORMULA changed_cell(N u, N change) : d(change), b(u + change), half(N(0.5) * b) {}
};

/// Returns the flux between two cells.
template <class N>
APSIS_FORMULA N centre_flux(const changed_cell<N>& before, const changed_cell<N>& after, bool limited) {
  const N all = N(1.0 / 24.0) * (after.d - before.d);
  return limited ? maximum(minimum(all, after.half), -before.half) : all;
}

template <class N>
APSIS_FORMULA N centre_average(N b, N flux_before, N flux_after, bool limited) {
  const N all = b + (flux_after - flux_before);
  // Removes negative results from the rounding of halves of the smallest numbers.
  return limited ? maximum(all, minimum(b, N(0.0))) : all;
}

/// Returns min(p, u) if `all`, or if u + d is negative; else p.
template <class N>
APSIS_FORMULA N lowered_centre(N u, N d, N p, bool all) {
  const N least = smaller(u, p);
  return all ? least : select(u + d < N(0.0), least, p);
}

}  // namespace apsis::APSIS_NUMBERS
APSIS_AFTER_FORMULAS();

#endif
