#pragma once

#include <apsis/steady/internal/dense_product.hpp>

#include <span>

namespace apsis {

/// LU factors of dense matrices by halves (Toledo, SIAM J. Matrix Anal. Appl. 18, 1997), so that nearly all
/// operations are products.
namespace dense_factors {

using dense_product::block;

/// a ← its factors L, with 1 on the diagonal, and U; rows ≥ columns. pivots[k] is the row that row k was
/// exchanged with, in this order. Returns false where a pivot is 0 or not a number; the factors are then
/// undefined.
bool factorize(const block& a, std::span<int> pivots);
/// Exchanges rows of b as factorize() did.
void exchange_pivot_rows(std::span<const int> pivots, const block& b);
/// b ← L⁻¹ b.
void solve_lower(const block& factors, const block& b);
/// b ← b U⁻¹.
void solve_upper_from_right(const block& factors, const block& b);

}  // namespace dense_factors
}  // namespace apsis
