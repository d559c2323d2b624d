#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "apsis/steady/internal/dense_product.cpp"
#include <hwy/foreach_target.h>

#include <apsis/steady/internal/dense_product.hpp>

#include <apsis/exec/simd-inl.hpp>

#include <algorithm>

HWY_BEFORE_NAMESPACE();
namespace apsis::HWY_NAMESPACE {

using dense_product::block;

using numbers = pack<wide>;

/// Size of a tile of c, in vectors of rows and in columns. The sums of a tile stay in registers.
constexpr int vectors_of_tile = 3, columns_of_tile = HWY_MAX_BYTES == 64 ? 8 : 4;
/// Number of products that are summed before c changes. This many columns of a tile of `a` fit into
/// the first-level cache.
constexpr int longest_sum = 128;

/// c ← c − a b for the rows of a tile. `rows` has a, with all rows of a tile for each term of the sums.
template <int columns>
HWY_INLINE void subtract_tile(const double* rows, const block& b, const block& c) {
  const int length = static_cast<int>(hn::Lanes(wide()));
  numbers sum[vectors_of_tile][columns];
  for (auto& of_vector : sum)
    for (numbers& one : of_vector) one = numbers(0.0);
  for (int k = 0; k < b.rows; ++k) {
    numbers here[vectors_of_tile];
    for (int i = 0; i < vectors_of_tile; ++i)
      here[i] = numbers::load(rows + (k * vectors_of_tile + i) * length);
    for (int j = 0; j < columns; ++j) {
      const numbers factor(b(k, j));
      for (int i = 0; i < vectors_of_tile; ++i) sum[i][j] = fma(here[i], factor, sum[i][j]);
    }
  }
  for (int j = 0; j < columns; ++j)
    for (int i = 0; i < vectors_of_tile; ++i) {
      const int count = c.rows - i * length;
      if (count <= 0) break;
      double* to = &c(i * length, j);
      store_some(load_some(to, count) - sum[i][j], count, to);
    }
}

/// Copies rows of a and appends zeros up to the height of a tile.
HWY_INLINE void copy_rows(const block& a, double* to) {
  const int length = static_cast<int>(hn::Lanes(wide()));
  for (int k = 0; k < a.columns; ++k)
    for (int i = 0; i < vectors_of_tile; ++i, to += length) {
      const int count = a.rows - i * length;
      (count > 0 ? load_some(&a(i * length, k), count) : numbers(0.0)).store(to);
    }
}

void subtract(const block& a, const block& b, const block& c) {
  alignas(64) double rows[longest_sum * vectors_of_tile * most_lanes];
  const int height = vectors_of_tile * static_cast<int>(hn::Lanes(wide()));
  for (int first = 0; first < a.columns; first += longest_sum) {
    const int depth = std::min(longest_sum, a.columns - first);
    for (int row = 0; row < c.rows; row += height) {
      const int count = std::min(height, c.rows - row);
      copy_rows(a.at(row, first, count, depth), rows);
      int column = 0;
      for (; column + columns_of_tile <= c.columns; column += columns_of_tile)
        subtract_tile<columns_of_tile>(rows, b.at(first, column, depth, columns_of_tile),
                                       c.at(row, column, count, columns_of_tile));
      for (; column < c.columns; ++column)
        subtract_tile<1>(rows, b.at(first, column, depth, 1), c.at(row, column, count, 1));
    }
  }
}

}  // namespace apsis::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace apsis {
namespace {
HWY_EXPORT(subtract);
}  // namespace

void dense_product::subtract(const block& a, const block& b, const block& c) {
  HWY_DYNAMIC_DISPATCH(subtract)(a, b, c);
}

}  // namespace apsis
#endif
