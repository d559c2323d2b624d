// Squares of eight by eight numbers, transposed in registers. With gathers Newton's method for discrete
// Maxwellians (model/nearby_cells.cpp) took 1.8 times as long.
#if defined(APSIS_EXEC_TRANSPOSE_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef APSIS_EXEC_TRANSPOSE_INL_HPP
#undef APSIS_EXEC_TRANSPOSE_INL_HPP
#else
#define APSIS_EXEC_TRANSPOSE_INL_HPP
#endif

#include <apsis/exec/simd-inl.hpp>

HWY_BEFORE_NAMESPACE();
namespace apsis::HWY_NAMESPACE {

#if HWY_TARGET == HWY_SCALAR

/// A square of one number.
HWY_INLINE void transpose(pack<wide>*) {}

#else

/// Transposes each square of two by two parts in the rows a and b. A part has `Distance` numbers.
template <int Distance>
HWY_INLINE void exchange_parts(pack<wide>& a, pack<wide>& b) {
  const auto x = a.v, y = b.v;
  const wide lanes;
  if constexpr (Distance == 1) {
    a = pack<wide>(hn::InterleaveLower(lanes, x, y));
    b = pack<wide>(hn::InterleaveUpper(lanes, x, y));
  } else if constexpr (2 * Distance == static_cast<int>(hn::MaxLanes(wide()))) {
    a = pack<wide>(hn::ConcatLowerLower(lanes, y, x));
    b = pack<wide>(hn::ConcatUpperUpper(lanes, y, x));
  } else {
    static_assert(Distance == 2);
    a = pack<wide>(hn::OddEvenBlocks(hn::SwapAdjacentBlocks(y), x));
    b = pack<wide>(hn::OddEvenBlocks(y, hn::SwapAdjacentBlocks(x)));
  }
}

/// Transposes a square of as many vectors as a vector has lanes.
template <int Distance = 1>
HWY_INLINE void transpose(pack<wide>* rows) {
  constexpr int length = static_cast<int>(hn::MaxLanes(wide()));
  if constexpr (Distance < length) {
    for (int i = 0; i < length; ++i)
      if ((i & Distance) == 0) exchange_parts<Distance>(rows[i], rows[i + Distance]);
    transpose<2 * Distance>(rows);
  }
}

#endif

/// Transposes a square of eight by eight numbers. load(row, column) returns a vector of a row from this
/// column on, and put(row, column, vector) takes one of the transposed square.
template <class Load, class Put>
HWY_INLINE void transpose_eight(const Load& load, const Put& put) {
  constexpr int length = static_cast<int>(hn::MaxLanes(wide()));
  for (int row = 0; row < most_lanes; row += length)
    for (int column = 0; column < most_lanes; column += length) {
      pack<wide> square[length];
      for (int i = 0; i < length; ++i) square[i] = load(row + i, column);
      transpose(square);
      for (int i = 0; i < length; ++i) put(column + i, row, square[i]);
    }
}

}  // namespace apsis::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
