#pragma once

#include <apsis/core/matrix.hpp>

namespace apsis {

/// Returns the product ab of two lower triangular matrices with a sixth of the operations of a full product,
/// and fewer where a has zeros. Dimensions are not checked.
template <class Real>
matrix<Real> lower_product(const matrix<Real>& a, const matrix<Real>& b) {
  matrix<Real> c(a.rows(), b.cols());
  for (std::size_t i = 0; i < a.rows(); ++i)
    for (std::size_t k = 0; k <= i; ++k) {
      if (a(i, k) == Real(0)) continue;
      for (std::size_t j = 0; j <= k; ++j) c(i, j) += a(i, k) * b(k, j);
    }
  return c;
}

/// Returns the product ax with a lower triangular matrix a, with 0 in the rows before `first`. Dimensions are
/// not checked.
template <class Real>
std::vector<Real> lower_product(const matrix<Real>& a, const std::vector<Real>& x, std::size_t first = 0) {
  std::vector<Real> y(a.rows(), Real(0));
  for (std::size_t i = first; i < a.rows(); ++i)
    for (std::size_t j = 0; j <= i; ++j)
      if (a(i, j) != Real(0)) y[i] += a(i, j) * x[j];
  return y;
}

}  // namespace apsis
