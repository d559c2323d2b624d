#include <apsis/steady/internal/dense_factors.hpp>

#include <apsis/core/index.hpp>

#include <cmath>
#include <cstddef>
#include <utility>

namespace apsis::dense_factors {
namespace {

/// Blocks of at most this many columns are not halved.
constexpr int smallest = 8;

bool factorize_columns(const block& a, std::span<int> pivots) {
  for (int k = 0; k < a.columns; ++k) {
    int largest = k;
    for (int i = k + 1; i < a.rows; ++i)
      if (std::abs(a(i, k)) > std::abs(a(largest, k))) largest = i;
    pivots[at(k)] = largest;
    if (largest != k)
      for (int j = 0; j < a.columns; ++j) std::swap(a(k, j), a(largest, j));
    if (!(std::abs(a(k, k)) > 0.0)) return false;
    const double inverse = 1.0 / a(k, k);
    for (int i = k + 1; i < a.rows; ++i) a(i, k) *= inverse;
    for (int j = k + 1; j < a.columns; ++j)
      for (int i = k + 1; i < a.rows; ++i) a(i, j) -= a(i, k) * a(k, j);
  }
  return true;
}

}  // namespace

bool factorize(const block& a, std::span<int> pivots) {
  if (a.columns <= smallest) return factorize_columns(a, pivots);
  const int left = a.columns / 2, right = a.columns - left, below = a.rows - left;
  const block of_left = a.at(0, 0, a.rows, left), upper = a.at(0, left, left, right),
              rest = a.at(left, left, below, right);
  const std::span<int> first = pivots.first(at(left)), second = pivots.subspan(at(left));
  if (!factorize(of_left, first)) return false;
  exchange_pivot_rows(first, a.at(0, left, a.rows, right));
  solve_lower(of_left.at(0, 0, left, left), upper);
  dense_product::subtract(a.at(left, 0, below, left), upper, rest);
  if (!factorize(rest, second)) return false;
  exchange_pivot_rows(second, a.at(left, 0, below, left));
  for (int& row : second) row += left;
  return true;
}

void exchange_pivot_rows(std::span<const int> pivots, const block& b) {
  for (int j = 0; j < b.columns; ++j)
    for (int k = 0; k < static_cast<int>(pivots.size()); ++k) std::swap(b(k, j), b(pivots[at(k)], j));
}

void solve_lower(const block& factors, const block& b) {
  const int size = factors.columns;
  if (size <= smallest) {
    for (int j = 0; j < b.columns; ++j)
      for (int k = 0; k < size; ++k)
        for (int i = k + 1; i < size; ++i) b(i, j) -= factors(i, k) * b(k, j);
    return;
  }
  const int half = size / 2, rest = size - half;
  const block upper = b.at(0, 0, half, b.columns), lower = b.at(half, 0, rest, b.columns);
  solve_lower(factors.at(0, 0, half, half), upper);
  dense_product::subtract(factors.at(half, 0, rest, half), upper, lower);
  solve_lower(factors.at(half, half, rest, rest), lower);
}

void solve_upper_from_right(const block& factors, const block& b) {
  const int size = factors.columns;
  if (size <= smallest) {
    for (int k = 0; k < size; ++k) {
      const double inverse = 1.0 / factors(k, k);
      for (int i = 0; i < b.rows; ++i) b(i, k) *= inverse;
      for (int j = k + 1; j < size; ++j)
        for (int i = 0; i < b.rows; ++i) b(i, j) -= b(i, k) * factors(k, j);
    }
    return;
  }
  const int half = size / 2, rest = size - half;
  const block left = b.at(0, 0, b.rows, half), right = b.at(0, half, b.rows, rest);
  solve_upper_from_right(factors.at(0, 0, half, half), left);
  dense_product::subtract(left, factors.at(0, half, half, rest), right);
  solve_upper_from_right(factors.at(half, half, rest, rest), right);
}

}  // namespace apsis::dense_factors
