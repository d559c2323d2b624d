// Walks along a pencil in the direction of motion, so that upwind formulas are written only once.
#if defined(APSIS_SPACE_WALK_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef APSIS_SPACE_WALK_INL_HPP
#undef APSIS_SPACE_WALK_INL_HPP
#else
#define APSIS_SPACE_WALK_INL_HPP
#endif

#include <apsis/exec/simd-inl.hpp>

#include <hwy/cache_control.h>

HWY_BEFORE_NAMESPACE();
namespace apsis::HWY_NAMESPACE {

enum class course { forward, backward, either };

/// Iterates over cells 0 … count−1 of a pencil for one pack of components. Cell j of the walk is cell j of
/// the pencil for components that move forward, and cell count−1−j for components that move backward. Cell
/// j−1 of the walk is therefore always upstream. A pack with components of both kinds reads both cells.
template <course C, class D>
class walk {
 public:
  using number = pack<D>;

  HWY_INLINE walk(int count, int k, const double* forward) : last_(count - 1), k_(k), forward_(forward) {}

  /// Loads from rows[i], the row of cell i of the pencil.
  HWY_INLINE number load(const double* const* rows, int j) const {
    if constexpr (C == course::forward) return number::load(rows[j] + k_);
    if constexpr (C == course::backward) return number::load(rows[last_ - j] + k_);
    return select(ahead(), number::load(rows[j] + k_), number::load(rows[last_ - j] + k_));
  }
  /// Loads like load(), and prefetches the next pack of the row. Rows of neighbouring cells are too far apart
  /// for the hardware prefetcher. The walk of the next pack will read each of them.
  HWY_INLINE number load_and_prefetch(const double* const* rows, int j) const {
    if constexpr (C != course::backward) prefetch_behind(rows[j] + k_);
    if constexpr (C != course::forward) prefetch_behind(rows[last_ - j] + k_);
    return load(rows, j);
  }
  /// Prefetches the next pack of cell j in equally spaced rows.
  HWY_INLINE void prefetch(const double* row, std::ptrdiff_t pitch, int j) const {
    if constexpr (C != course::backward) prefetch_behind(row + j * pitch + k_);
    if constexpr (C != course::forward) prefetch_behind(row + (last_ - j) * pitch + k_);
  }
  /// Loads from equally spaced rows; `row` is the row of cell 0 of the pencil.
  HWY_INLINE number load(const double* row, std::ptrdiff_t pitch, int j) const {
    if constexpr (C == course::forward) return number::load(row + j * pitch + k_);
    if constexpr (C == course::backward) return number::load(row + (last_ - j) * pitch + k_);
    return select(ahead(), number::load(row + j * pitch + k_), number::load(row + (last_ - j) * pitch + k_));
  }
  /// Loads from the downstream row: `right` for components that move forward, else `left`.
  HWY_INLINE number load_downstream(const double* left, const double* right, std::ptrdiff_t pitch,
                                    int j) const {
    if constexpr (C == course::forward) return load(right, pitch, j);
    if constexpr (C == course::backward) return load(left, pitch, j);
    return select(ahead(), number::load(right + j * pitch + k_),
                  number::load(left + (last_ - j) * pitch + k_));
  }
  HWY_INLINE void store(number x, double* row, std::ptrdiff_t pitch, int j) const {
    if constexpr (C == course::forward) {
      x.store(row + j * pitch + k_);
    } else if constexpr (C == course::backward) {
      x.store(row + (last_ - j) * pitch + k_);
    } else {
      hn::BlendedStore(x.v, ahead(), D(), row + j * pitch + k_);
      hn::BlendedStore(x.v, hn::Not(ahead()), D(), row + (last_ - j) * pitch + k_);
    }
  }

 private:
  /// Prefetches the pack after this one, except in the scalar remainder of a row.
  static HWY_INLINE void prefetch_behind(const double* at) {
    constexpr std::size_t length = hn::MaxLanes(D());
    if constexpr (length > 1) hwy::Prefetch(at + length);
  }
  HWY_INLINE auto ahead() const { return number::load(forward_ + k_) > number(0.5); }

  int last_, k_;
  const double* forward_;
};

/// Calls body(walk, k) for every pack of `width` components; forward[k] is 1 if component k moves forward,
/// else 0.
template <class Body>
HWY_INLINE void for_walks(const double* forward, int count, int width, const Body& body) {
  for_packs(width, [&](auto lanes, int k) APSIS_PACKED {
    using D = decltype(lanes);
    const auto ahead = pack<D>::load(forward + k) > pack<D>(0.5);
    if (pack<D>::all(ahead)) {
      body(walk<course::forward, D>(count, k, forward), k);
    } else if (!pack<D>::any(ahead)) {
      body(walk<course::backward, D>(count, k, forward), k);
    } else {
      body(walk<course::either, D>(count, k, forward), k);
    }
  });
}

}  // namespace apsis::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
