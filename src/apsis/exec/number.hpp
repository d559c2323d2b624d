// Formulas on a number type. A formula is a template on a number N and uses only the operations below. N is a
// vector of the host (pack, exec/simd-inl.hpp), a double (reference in tests, kernels of other processors),
// or a count of operations (exec/counted.hpp). Headers of formulas lie in the folders formulas/ of the rooms.
// They include neither the standard library nor Highway, throw nothing and allocate nothing. Such a header
// reads
//   #if defined(APSIS_SCHEME_FORMULAS_LIMITER) == defined(HWY_TARGET_TOGGLE)
//   #ifdef APSIS_SCHEME_FORMULAS_LIMITER
//   #undef APSIS_SCHEME_FORMULAS_LIMITER
//   #else
//   #define APSIS_SCHEME_FORMULAS_LIMITER
//   #endif
//   #include <apsis/exec/number.hpp>
//   APSIS_BEFORE_FORMULAS();
//   namespace apsis::APSIS_NUMBERS {
//   template <class N> APSIS_FORMULA N mean(N a, N b) { return N(0.5) * (a + b); }
//   }
//   APSIS_AFTER_FORMULAS();
//   #endif
// A kernel file is compiled once for each instruction set, and includes the header as often. A function must
// carry the attributes of the instructions that it uses. APSIS_NUMBERS is the namespace of the instruction
// set there; it is `scalar` in all other files.
//
// Operations on numbers a, b, c of type N, beside + − * / and the comparisons < and >, which return a mask:
//   N(x)                     the constant x;
//   fma(a, b, c)             ab + c, rounded once (twice where the instruction set has no such instruction);
//   negative_fma(a, b, c)    c − ab, rounded in the same way;
//   select(mask, a, b)       a where the mask is set, else b;
//   smaller(a, b)            a < b ? a : b, thus b if either is NaN; also larger(a, b);
//   minimum(a, b)            as smaller, but unspecified if either is NaN or both are zeros; also maximum;
//   absolute(a)              |a|;
//   any<N>(mask), all<N>(mask)   whether the mask is set somewhere, or everywhere. A formula may use them to
//                            skip work, not to change a result: a number must not depend on its neighbours;
//   inverse_power_of_two(a)  2^−e for a = 2^e m, 1 ≤ m < 2, a normal and below 2^1022;
//   truncated(a)             a rounded towards 0, |a| < 2^31;
//   power_of_two(a)          2^a for an integer −1022 ≤ a ≤ 1023;
//   exponent_near_one(a)     e with 2^−e a between √½ and √2, for a normal and positive;
//   scaled_near_one(a)       2^−e a with this e.
// Files with formulas on doubles are compiled with -ffp-contract=off, so that only the source requests fma.
#if defined(HWY_TARGET_INCLUDE) || defined(APSIS_PACKS)
#include <apsis/exec/simd-inl.hpp>
#endif

#ifndef APSIS_EXEC_NUMBER_HPP
#define APSIS_EXEC_NUMBER_HPP

/// Attribute of formulas: inlined into the loop that applies them.
#define APSIS_FORMULA inline __attribute__((always_inline))

#if defined(HWY_TARGET_INCLUDE) || defined(APSIS_PACKS)

#define APSIS_BEFORE_FORMULAS() HWY_BEFORE_NAMESPACE()
#define APSIS_AFTER_FORMULAS() HWY_AFTER_NAMESPACE()
#define APSIS_NUMBERS HWY_NAMESPACE

#else

#define APSIS_BEFORE_FORMULAS() static_assert(true)
#define APSIS_AFTER_FORMULAS() static_assert(true)
#define APSIS_NUMBERS scalar

/// Formulas on single numbers, and the operations on a double.
namespace apsis::scalar {

/// Returns ab + c, rounded once.
APSIS_FORMULA double fma(double a, double b, double c) {
  return __builtin_fma(a, b, c);
}
/// Returns c − ab, rounded once.
APSIS_FORMULA double negative_fma(double a, double b, double c) {
  return __builtin_fma(-a, b, c);
}
/// Returns `yes` where the mask is set, else `no`; for every number type whose comparisons return bool.
template <class N>
APSIS_FORMULA N select(bool mask, N yes, N no) {
  return mask ? yes : no;
}
/// Whether the mask is set.
template <class N>
APSIS_FORMULA bool any(bool mask) {
  return mask;
}
/// Whether the mask is set.
template <class N>
APSIS_FORMULA bool all(bool mask) {
  return mask;
}
/// Returns a where a < b, else b.
template <class N>
APSIS_FORMULA N smaller(N a, N b) {
  return a < b ? a : b;
}
/// Returns a where a > b, else b.
template <class N>
APSIS_FORMULA N larger(N a, N b) {
  return a > b ? a : b;
}
/// Returns the smaller number; unspecified for NaN and for two zeros.
template <class N>
APSIS_FORMULA N minimum(N a, N b) {
  return a < b ? a : b;
}
/// Returns the larger number; unspecified for NaN and for two zeros.
template <class N>
APSIS_FORMULA N maximum(N a, N b) {
  return a > b ? a : b;
}
/// Returns the absolute value of a.
APSIS_FORMULA double absolute(double a) {
  return __builtin_fabs(a);
}

/// Returns the bits of a double.
APSIS_FORMULA unsigned long long bits_of(double a) {
  return __builtin_bit_cast(unsigned long long, a);
}
/// Returns the double of these bits.
APSIS_FORMULA double from_bits(unsigned long long bits) {
  return __builtin_bit_cast(double, bits);
}

/// Returns 2^−e for a = 2^e m, 1 ≤ m < 2, a normal and below 2^1022.
APSIS_FORMULA double inverse_power_of_two(double a) {
  return from_bits(0x7fe0000000000000ull - (bits_of(a) & 0x7ff0000000000000ull));
}
/// Returns a rounded towards 0, for −2^31 < a < 2^31.
APSIS_FORMULA double truncated(double a) {
  return __builtin_trunc(a) + 0.0;  // not −0; defined also for NaN, which a conversion to int is not
}
/// Returns 2^a for an integer −1022 ≤ a ≤ 1023.
APSIS_FORMULA double power_of_two(double a) {
  return from_bits(bits_of(a + (0x1p52 + 1023.0)) << 52);
}
/// Returns e + 1023 with e of exponent_near_one(): fractions from about √2 on carry into the exponent.
APSIS_FORMULA unsigned long long biased_near_one(double a) {
  return (bits_of(a) + 0x00095f6200000000ull) >> 52;
}
/// Returns e with 2^−e a between √½ and √2, for a normal and positive.
APSIS_FORMULA double exponent_near_one(double a) {
  return static_cast<double>(static_cast<int>(biased_near_one(a)) - 1023);
}
/// Returns 2^−e a with e of exponent_near_one(a).
APSIS_FORMULA double scaled_near_one(double a) {
  return from_bits(bits_of(a) - ((biased_near_one(a) - 1023) << 52));
}

}  // namespace apsis::scalar

#endif
#endif
