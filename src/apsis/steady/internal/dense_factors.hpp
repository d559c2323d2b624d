#pragma once

#include <apsis/steady/internal/dense_product.hpp>

#include <span>

namespace apsis {

/// LU factors of dense matrices by recursive halving (Toledo, SIAM J. Matrix Anal. Appl. 18, 1997). Nearly
/// all operations are products.
namespace dense_factors {

using dense_product::block;

/// a ← its factors L, with 1 on the diagonal, and U; a has at least as many rows as columns. pivots[k] is
/// the row that was exchanged with row k, in this order. Returns false if a pivot is 0 or NaN; the factors
/// are then undefined.
bool factorize(const block& a, std::span<int> pivots);
/// Applies the exchanges of factorize() to the rows of b.
void exchange_pivot_rows(std::span<const int> pivots, const block& b);
/// b ← L⁻¹ b.
void solve_lower(const block& factors, const block& b);
/// b ← b U⁻¹.
void solve_upper_from_right(const block& factors, const block& b);

}  // namespace dense_factors
}  // namespace apsis
