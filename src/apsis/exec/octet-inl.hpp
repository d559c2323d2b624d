// Eight numbers side by side, whatever the length of vectors. Sums and walks over them have the same bits on
// every instruction set, and in eight lanes of a device.
#if defined(APSIS_EXEC_OCTET_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef APSIS_EXEC_OCTET_INL_HPP
#undef APSIS_EXEC_OCTET_INL_HPP
#else
#define APSIS_EXEC_OCTET_INL_HPP
#endif

#include <apsis/exec/simd-inl.hpp>

#include <type_traits>

HWY_BEFORE_NAMESPACE();
namespace apsis::HWY_NAMESPACE {

/// A mask of several vectors.
template <class Mask, int Count>
struct several_masks {
  Mask part[Count];
};

/// Several vectors, with the operations of exec/number.hpp.
template <int Count>
struct several {
  using one = pack<wide>;
  using mask = several_masks<decltype(one(0.0) < one(0.0)), Count>;
  one part[Count];

  several() = default;
  HWY_INLINE several(double from) {
    for (one& p : part) p = one(from);
  }

  template <class Function>
  static HWY_INLINE several of(const Function& value) {
    several all;
    for (int i = 0; i < Count; ++i) all.part[i] = value(i);
    return all;
  }
  template <class Function>
  static HWY_INLINE mask masks_of(const Function& value) {
    mask all;
    for (int i = 0; i < Count; ++i) all.part[i] = value(i);
    return all;
  }

  static HWY_INLINE several load(const double* from) {
    return of([&](int i) APSIS_PACKED { return one::load(from + i * most_lanes / Count); });
  }
  HWY_INLINE void store(double* to) const {
    for (int i = 0; i < Count; ++i) part[i].store(to + i * most_lanes / Count);
  }
  HWY_INLINE several loaded_once() const {
    return of([&](int i) APSIS_PACKED { return part[i].loaded_once(); });
  }
  template <class Mask>
  static HWY_INLINE bool any(const Mask& of_all) {
    bool some = false;
    for (int i = 0; i < Count; ++i) some = some || one::any(of_all.part[i]);
    return some;
  }
  template <class Mask>
  static HWY_INLINE bool all(const Mask& of_all) {
    bool every = true;
    for (int i = 0; i < Count; ++i) every = every && one::all(of_all.part[i]);
    return every;
  }

#define APSIS_OPERATION(name)                                                  \
  friend HWY_INLINE several name(const several& a, const several& b) {         \
    return of([&](int i) APSIS_PACKED { return name(a.part[i], b.part[i]); }); \
  }
#define APSIS_OPERATOR(sign)                                                    \
  friend HWY_INLINE several operator sign(const several& a, const several& b) { \
    return of([&](int i) APSIS_PACKED { return a.part[i] sign b.part[i]; });    \
  }
#define APSIS_COMPARISON(sign)                                                     \
  friend HWY_INLINE mask operator sign(const several& a, const several& b) {       \
    return masks_of([&](int i) APSIS_PACKED { return a.part[i] sign b.part[i]; }); \
  }
#define APSIS_FUNCTION(name)                                        \
  friend HWY_INLINE several name(const several& a) {                \
    return of([&](int i) APSIS_PACKED { return name(a.part[i]); }); \
  }
  APSIS_OPERATOR(+)
  APSIS_OPERATOR(-)
  APSIS_OPERATOR(*)
  APSIS_OPERATOR(/)
  APSIS_COMPARISON(<)
  APSIS_COMPARISON(>)
  APSIS_OPERATION(smaller)
  APSIS_OPERATION(larger)
  APSIS_OPERATION(minimum)
  APSIS_OPERATION(maximum)
  APSIS_FUNCTION(absolute)
  APSIS_FUNCTION(truncated)
  APSIS_FUNCTION(power_of_two)
  APSIS_FUNCTION(inverse_power_of_two)
  APSIS_FUNCTION(exponent_near_one)
  APSIS_FUNCTION(scaled_near_one)
#undef APSIS_OPERATION
#undef APSIS_OPERATOR
#undef APSIS_COMPARISON
#undef APSIS_FUNCTION
  friend HWY_INLINE several operator-(const several& a) {
    return of([&](int i) APSIS_PACKED { return -a.part[i]; });
  }
  friend HWY_INLINE several fma(const several& a, const several& b, const several& c) {
    return of([&](int i) APSIS_PACKED { return fma(a.part[i], b.part[i], c.part[i]); });
  }
  friend HWY_INLINE several negative_fma(const several& a, const several& b, const several& c) {
    return of([&](int i) APSIS_PACKED { return negative_fma(a.part[i], b.part[i], c.part[i]); });
  }
  friend HWY_INLINE several select(const mask& which, const several& yes, const several& no) {
    return of([&](int i) APSIS_PACKED { return select(which.part[i], yes.part[i], no.part[i]); });
  }
};

/// Eight numbers: one vector if it has eight lanes, otherwise several vectors.
using octet = std::conditional_t<vectors_of_chains == 1, pack<wide>, several<vectors_of_chains>>;

/// Returns the vectors of an octet.
HWY_INLINE const pack<wide>* vectors_of(const pack<wide>& x) {
  return &x;
}
HWY_INLINE pack<wide>* vectors_of(pack<wide>& x) {
  return &x;
}
template <int Count>
HWY_INLINE const pack<wide>* vectors_of(const several<Count>& x) {
  return x.part;
}
template <int Count>
HWY_INLINE pack<wide>* vectors_of(several<Count>& x) {
  return x.part;
}

/// The operations on eight numbers that formulas require (model/formulas/velocity_line.hpp), on
/// this processor.
struct octet_group {
  using number = octet;

  /// Returns the first min(count, 8) numbers, count ≥ 1, followed by zeros.
  HWY_INLINE octet load(const double* from, int count) const {
    octet x;
    constexpr int length = most_lanes / vectors_of_chains;
    for (int i = 0; i < vectors_of_chains; ++i)
      vectors_of(x)[i] = load_some(from + i * length, count > i * length ? count - i * length : 0);
    return x;
  }
  /// Returns eight numbers; load_once() keeps them in registers.
  HWY_INLINE octet load(const double* from) const { return octet::load(from); }
  HWY_INLINE octet load_once(const double* from) const { return octet::load(from).loaded_once(); }
  /// Returns the first min(count, 8) numbers of x, count ≥ 1, followed by zeros.
  HWY_INLINE octet first(const octet& x, int count) const {
    octet some;
    constexpr int length = most_lanes / vectors_of_chains;
    for (int i = 0; i < vectors_of_chains; ++i) {
      const int left = count - i * length, here = left < 0 ? 0 : left < length ? left : length;
      const auto inside = hn::FirstN(wide(), static_cast<std::size_t>(here));
      vectors_of(some)[i] = pack<wide>(hn::IfThenElseZero(inside, vectors_of(x)[i].v));
    }
    return some;
  }
  /// Stores the first min(count, 8) numbers, count ≥ 1.
  HWY_INLINE void store(const octet& x, int count, double* to) const {
    constexpr int length = most_lanes / vectors_of_chains;
    for (int i = 0; i < vectors_of_chains && count > i * length; ++i)
      store_some(vectors_of(x)[i], count - i * length, to + i * length);
  }
  HWY_INLINE void store(const octet& x, double* to) const { x.store(to); }
  /// Returns the numbers 0 … 7.
  HWY_INLINE octet numbers() const {
    octet x;
    constexpr int length = most_lanes / vectors_of_chains;
    for (int i = 0; i < vectors_of_chains; ++i)
      vectors_of(x)[i] = pack<wide>(hn::Iota(wide(), static_cast<double>(i * length)));
    return x;
  }
  /// Returns the sum of all eight, by adding halves until one number remains.
  HWY_INLINE double total(const octet& x) const { return total_of_chains(vectors_of(x)); }
};

}  // namespace apsis::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
