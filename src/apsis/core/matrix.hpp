#pragma once

#include <cstddef>
#include <vector>

namespace apsis {

/// A small dense row-major matrix for tableaux. It is not over-aligned, and therefore can cross library
/// boundaries even if both sides are compiled for different instruction sets.
template <class Real>
class matrix {
 public:
  matrix() = default;
  /// Value-initializes every entry: 0, or an empty string.
  matrix(std::size_t rows, std::size_t cols) : rows_(rows), cols_(cols), data_(rows * cols) {}

  /// Returns the n × n identity matrix.
  static matrix identity(std::size_t n) {
    matrix eye(n, n);
    for (std::size_t i = 0; i < n; ++i) eye(i, i) = Real(1);
    return eye;
  }

  /// Entry a_ij, with i, j from 0; indices are not checked.
  Real& operator()(std::size_t i, std::size_t j) { return data_[i * cols_ + j]; }
  /// Entry a_ij of a constant matrix.
  const Real& operator()(std::size_t i, std::size_t j) const { return data_[i * cols_ + j]; }
  std::size_t rows() const { return rows_; }  ///< number of rows
  std::size_t cols() const { return cols_; }  ///< number of columns

 private:
  std::size_t rows_ = 0, cols_ = 0;
  std::vector<Real> data_;
};

/// Returns the matrix product ab. Requires a.cols() = b.rows(), which is not checked.
template <class Real>
matrix<Real> operator*(const matrix<Real>& a, const matrix<Real>& b) {
  matrix<Real> c(a.rows(), b.cols());
  for (std::size_t i = 0; i < a.rows(); ++i)
    for (std::size_t k = 0; k < a.cols(); ++k)
      for (std::size_t j = 0; j < b.cols(); ++j) c(i, j) += a(i, k) * b(k, j);
  return c;
}

/// Returns the matrix-vector product ax. Requires a.cols() = x.size(), which is not checked.
template <class Real>
std::vector<Real> operator*(const matrix<Real>& a, const std::vector<Real>& x) {
  std::vector<Real> y(a.rows(), Real(0));
  for (std::size_t i = 0; i < a.rows(); ++i)
    for (std::size_t j = 0; j < a.cols(); ++j) y[i] += a(i, j) * x[j];
  return y;
}

/// Returns the inverse of a square lower triangular matrix with nonzero diagonal, by forward substitution.
/// Neither requirement is checked.
template <class Real>
matrix<Real> inverse_lower(const matrix<Real>& lower) {
  const std::size_t n = lower.rows();
  matrix<Real> inverse(n, n);
  for (std::size_t j = 0; j < n; ++j) {
    inverse(j, j) = Real(1) / lower(j, j);
    for (std::size_t i = j + 1; i < n; ++i) {
      Real sum(0);
      for (std::size_t k = j; k < i; ++k) sum += lower(i, k) * inverse(k, j);
      inverse(i, j) = -sum / lower(i, i);
    }
  }
  return inverse;
}

}  // namespace apsis
