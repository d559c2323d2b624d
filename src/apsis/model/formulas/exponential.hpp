// Exponential and logarithm.
#if defined(APSIS_MODEL_FORMULAS_EXPONENTIAL) == defined(HWY_TARGET_TOGGLE)
#ifdef APSIS_MODEL_FORMULAS_EXPONENTIAL
#undef APSIS_MODEL_FORMULAS_EXPONENTIAL
#else
#define APSIS_MODEL_FORMULAS_EXPONENTIAL
#endif

#include <apsis/exec/number.hpp>

APSIS_BEFORE_FORMULAS();
namespace apsis::APSIS_NUMBERS {

/// Returns e^x to about one unit in the last place for x ≤ 700; 0 for x ≤ −1000 and NaN. Let q be x/log 2
/// rounded and r = x − q log 2, |r| ≤ ½ log 2. Then e^x = 2^q (1 + r + r² p(r)). log 2 is split into two
/// numbers, so that q times the first is exact. Constants, coefficients of p and order of operations are
/// those of Highway 1.0 (hwy/contrib/math/math-inl.h), bit for bit.
template <class N>
APSIS_FORMULA N exp_of(N x) {
  const N half = select(x < N(0.0), N(-0.5), N(0.5));
  const N q = truncated(fma(x, N(1.442695040888963407359924681), half));
  N r = fma(q, N(-0.6931471805596629565116018), x);
  r = fma(q, N(-0.28235290563031577122588448175e-12), r);
  // p by Estrin's scheme: the sums of pairs overlap in time.
  const N r2 = r * r, r4 = r2 * r2, r8 = r4 * r4;
  const N p01 = fma(N(0.166666666666666851703837), r, N(0.5));
  const N p23 = fma(N(0.00833333333331652721664984), r, N(0.0416666666666665047591422));
  const N p45 = fma(N(0.000198412698960509205564975), r, N(0.00138888888889774492207962));
  const N p67 = fma(N(2.75572362911928827629423e-6), r, N(2.4801587159235472998791e-5));
  const N p89 = fma(N(2.51112930892876518610661e-8), r, N(2.75573911234900471893338e-7));
  const N p =
      fma(r8, fma(r2, N(2.08860621107283687536341e-9), p89), fma(r4, fma(r2, p67, p45), fma(r2, p23, p01)));
  const N mantissa = fma(p, r2, r) + N(1.0);
  // Two factors, because 2^q may overflow or underflow although the result does not.
  const N first = truncated(N(0.5) * q);
  const N y = mantissa * power_of_two(first) * power_of_two(q - first);
  return select(x > N(-1000.0), y, N(0.0));
}

/// Largest |x| of exp_of_small().
inline constexpr double small_exponent = 0x1p-6;

/// Returns e^x to about one unit in the last place for |x| ≤ small_exponent, by a Taylor polynomial. The
/// first omitted term is x⁷/5040 < 5e-17.
template <class N>
APSIS_FORMULA N exp_of_small(N x) {
  const N x2 = x * x;
  const N p01 = fma(N(1.0 / 6.0), x, N(0.5)), p23 = fma(N(1.0 / 120.0), x, N(1.0 / 24.0));
  return fma(fma(fma(N(1.0 / 720.0), x2, p23), x2, p01), x2, x) + N(1.0);
}

/// Returns log x to about one unit in the last place, for x normal and positive. With x = 2^e y, √½ ≤ y < √2,
/// and z = (y − 1)/(y + 1), it is e log 2 + 2 artanh z. The polynomial is that of log() in musl, in the order
/// of operations of Highway 1.0.
template <class N>
APSIS_FORMULA N log_of(N x) {
  const N e = exponent_near_one(x), y = scaled_near_one(x), above = y - N(1.0);
  const N z = above / (y + N(1.0)), z2 = z * z, z4 = z2 * z2;
  const N even =
      fma(fma(fma(N(0.1479819860511658591), z4, N(0.1818357216161805012)), z4, N(0.2857142874366239149)), z4,
          N(0.6666666666666735130));
  const N odd =
      fma(fma(N(0.1531383769920937332), z4, N(0.2222219843214978396)), z4, N(0.3999999999940941908));
  const N p = fma(even, z2, odd * z4);
  const N tail = fma(z, above - p, -(e * N(1.90821492927058770002e-10))) - above;
  return fma(e, N(0.693147180369123816490), -tail);
}

}  // namespace apsis::APSIS_NUMBERS
APSIS_AFTER_FORMULAS();

#endif
