// Vectors for kernels. A kernel file is compiled once for each instruction set: it begins with
//   #undef HWY_TARGET_INCLUDE
//   #define HWY_TARGET_INCLUDE "apsis/scheme/limiter.cpp"     (the file itself)
//   #include <hwy/foreach_target.h>
//   #include <apsis/exec/simd-inl.hpp>
// This header may therefore be included several times. The instruction set is chosen at run time (Highway:
// HWY_EXPORT, HWY_DYNAMIC_DISPATCH), so that a program built for the baseline architecture is not limited
// to it.
#if defined(APSIS_CORE_SIMD_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef APSIS_CORE_SIMD_INL_HPP
#undef APSIS_CORE_SIMD_INL_HPP
#else
#define APSIS_CORE_SIMD_INL_HPP
#endif

#include <cstddef>
#include <cstdint>

#include <hwy/highway.h>

/// Headers of formulas included after this one are for packs (exec/number.hpp).
#ifndef APSIS_PACKS
#define APSIS_PACKS
#endif

HWY_BEFORE_NAMESPACE();
namespace apsis::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// Attribute of lambdas on packs: compiled for the instruction set and inlined into the calling loop.
#ifndef APSIS_PACKED
#define APSIS_PACKED HWY_ATTR __attribute__((always_inline))
#endif

/// Widest vector, at most a cache line; rows of a field are padded to it (mesh/field.hpp).
using wide = hn::CappedTag<double, 8>;
/// A single number, for the ends of rows that are not padded.
using narrow = hn::CappedTag<double, 1>;

/// A vector of doubles with the operations of exec/number.hpp. They round like those on one double; fma(a, b,
/// c) = ab + c rounds once where the instruction set has it.
template <class D>
struct pack {
  hn::Vec<D> v;

  pack() = default;  ///< without values
  HWY_INLINE pack(hn::Vec<D> from) : v(from) {}
  HWY_INLINE pack(double from) : v(hn::Set(D(), from)) {}
  static HWY_INLINE pack load(const double* from) { return {hn::LoadU(D(), from)}; }
  HWY_INLINE void store(double* to) const { hn::StoreU(v, D(), to); }
  /// Returns the same values, kept in a register. Otherwise a compiler may repeat a load for every use, which
  /// costs time where loads are the bottleneck.
  HWY_INLINE pack loaded_once() const {
    pack copy = *this;
#if HWY_ARCH_X86 && HWY_COMPILER_GCC_ACTUAL  // clang rejects this operand
    asm("" : "+v"(copy.v.raw));
#endif
    return copy;
  }

  /// Whether a comparison holds for any number of a pack, or for all numbers.
  template <class Mask>
  static HWY_INLINE bool any(Mask mask) {
    return !hn::AllFalse(D(), mask);
  }
  template <class Mask>
  static HWY_INLINE bool all(Mask mask) {
    return hn::AllTrue(D(), mask);
  }

  friend HWY_INLINE pack operator+(pack a, pack b) { return {hn::Add(a.v, b.v)}; }
  friend HWY_INLINE pack operator-(pack a, pack b) { return {hn::Sub(a.v, b.v)}; }
  friend HWY_INLINE pack operator*(pack a, pack b) { return {hn::Mul(a.v, b.v)}; }
  friend HWY_INLINE pack operator/(pack a, pack b) { return {hn::Div(a.v, b.v)}; }
  friend HWY_INLINE pack operator-(pack a) { return {hn::Neg(a.v)}; }
  friend HWY_INLINE pack fma(pack a, pack b, pack c) { return {hn::MulAdd(a.v, b.v, c.v)}; }
  /// Returns c − ab.
  friend HWY_INLINE pack negative_fma(pack a, pack b, pack c) { return {hn::NegMulAdd(a.v, b.v, c.v)}; }
  friend HWY_INLINE auto operator<(pack a, pack b) { return hn::Lt(a.v, b.v); }
  friend HWY_INLINE auto operator>(pack a, pack b) { return hn::Gt(a.v, b.v); }
};

/// Selects `yes` where the mask is set, otherwise `no`.
template <class D, class Mask>
HWY_INLINE pack<D> select(Mask mask, pack<D> yes, pack<D> no) {
  return {hn::IfThenElse(mask, yes.v, no.v)};
}

/// Minimum and maximum; b if either is NaN.
template <class D>
HWY_INLINE pack<D> smaller(pack<D> a, pack<D> b) {
  return select(a < b, a, b);
}
template <class D>
HWY_INLINE pack<D> larger(pack<D> a, pack<D> b) {
  return select(a > b, a, b);
}

/// Returns 2^−e for a = 2^e m, 1 ≤ m < 2, a normal and below 2^1022. Multiplying by it scales like a
/// division, without the rounding and the cost.
template <class D>
HWY_INLINE pack<D> inverse_power_of_two(pack<D> a) {
  const hn::RebindToUnsigned<D> bits;
  const auto exponent = hn::And(hn::BitCast(bits, a.v), hn::Set(bits, std::uint64_t{0x7ff0000000000000}));
  return {hn::BitCast(D(), hn::Sub(hn::Set(bits, std::uint64_t{0x7fe0000000000000}), exponent))};
}

/// Maximum and minimum; unspecified if either is NaN.
template <class D>
HWY_INLINE pack<D> maximum(pack<D> a, pack<D> b) {
  return {hn::Max(a.v, b.v)};
}

template <class D>
HWY_INLINE pack<D> minimum(pack<D> a, pack<D> b) {
  return {hn::Min(a.v, b.v)};
}

template <class D>
HWY_INLINE pack<D> absolute(pack<D> a) {
  return {hn::Abs(a.v)};
}

/// Returns a rounded towards 0. exec/number.hpp defines this and the following operations.
template <class D>
HWY_INLINE pack<D> truncated(pack<D> a) {
  return {hn::PromoteTo(D(), hn::DemoteTo(hn::Rebind<std::int32_t, D>(), a.v))};
}

template <class D>
HWY_INLINE pack<D> power_of_two(pack<D> a) {
  const hn::RebindToUnsigned<D> bits;
  return {hn::BitCast(D(), hn::ShiftLeft<52>(hn::BitCast(bits, (a + pack<D>(0x1p52 + 1023.0)).v)))};
}

/// Returns e + 1023 as an integer, with e of exponent_near_one(): fractions from about √2 on carry into
/// the exponent.
template <class D>
HWY_INLINE auto biased_near_one(pack<D> a) {
  const hn::RebindToUnsigned<D> bits;
  return hn::ShiftRight<52>(
      hn::Add(hn::BitCast(bits, a.v), hn::Set(bits, std::uint64_t{0x00095f6200000000})));
}

template <class D>
HWY_INLINE pack<D> exponent_near_one(pack<D> a) {
  const hn::RebindToUnsigned<D> bits;
  // The fraction bits of 2^52 + n are the integer n < 2^52.
  const auto shifted = hn::Or(biased_near_one(a), hn::BitCast(bits, hn::Set(D(), 0x1p52)));
  return pack<D>(hn::BitCast(D(), shifted)) - pack<D>(0x1p52 + 1023.0);
}

template <class D>
HWY_INLINE pack<D> scaled_near_one(pack<D> a) {
  const hn::RebindToUnsigned<D> bits;
  const auto exponent = hn::Sub(biased_near_one(a), hn::Set(bits, std::uint64_t{1023}));
  return {hn::BitCast(D(), hn::Sub(hn::BitCast(bits, a.v), hn::ShiftLeft<52>(exponent)))};
}

/// Whether a mask of packs N is set somewhere, or everywhere.
template <class N, class Mask>
HWY_INLINE bool any(Mask mask) {
  return N::any(mask);
}
template <class N, class Mask>
HWY_INLINE bool all(Mask mask) {
  return N::all(mask);
}

/// Largest number of doubles in a `wide` vector.
inline constexpr int most_lanes = 8;

/// Returns the first `count` ≥ 0 numbers, at most a whole vector, followed by zeros.
HWY_INLINE pack<wide> load_some(const double* from, int count) {
  if (count >= static_cast<int>(hn::Lanes(wide()))) return pack<wide>::load(from);
  // MaskedLoad of vectors longer than two numbers reads none beyond `count`.
  if constexpr (HWY_MAX_BYTES > 16)
    return pack<wide>(hn::MaskedLoad(hn::FirstN(wide(), static_cast<std::size_t>(count)), wide(), from));
  alignas(64) double all[most_lanes] = {};
  for (int k = 0; k < count; ++k) all[k] = from[k];
  return pack<wide>::load(all);
}

/// Stores the first `count` numbers, at most a whole vector.
HWY_INLINE void store_some(pack<wide> x, int count, double* to) {
  if (count >= static_cast<int>(hn::Lanes(wide()))) return x.store(to);
  hn::BlendedStore(x.v, hn::FirstN(wide(), static_cast<std::size_t>(count)), wide(), to);
}

/// Sums that do not depend on the instruction set: number j is added in chain j mod sum_chains. Each lane of
/// a vector belongs to one chain.
inline constexpr int sum_chains = 8;
inline constexpr int vectors_of_chains = sum_chains / static_cast<int>(hn::MaxLanes(wide()));

/// Returns the sum of all chains, by adding halves until one number remains.
HWY_INLINE double total_of_chains(const pack<wide>* of_vectors) {
  pack<wide> all[vectors_of_chains];
  for (int i = 0; i < vectors_of_chains; ++i) all[i] = of_vectors[i];
  for (int half = vectors_of_chains / 2; half > 0; half /= 2)
    for (int i = 0; i < half; ++i) all[i] = all[i] + all[i + half];
  return hn::GetLane(hn::SumOfLanes(wide(), all[0].v));
}

/// Calls body(pack type, k) for k = 0 … width−1, one pack at a time and the remainder one by one.
template <class Body>
HWY_INLINE void for_packs(int width, const Body& body) {
  const int length = static_cast<int>(hn::Lanes(wide()));
  int k = 0;
  for (; k + length <= width; k += length) body(wide(), k);
  for (; k < width; ++k) body(narrow(), k);
}

}  // namespace apsis::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
