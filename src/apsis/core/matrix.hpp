#pragma once

#include <cstddef>
#include <vector>

namespace apsis {

/// A small dense row-major matrix for tableaux. No alignment requirement of its own, so that it may cross
/// the boundary of the library whatever instruction set either side is compiled for.
template <class Real>
class matrix {
 public:
  matrix() = default;
  /// Every entry is Real(): 0, or an empty text.
  matrix(std::size_t rows, std::size_t cols) : rows_(rows), cols_(cols), data_(rows * cols) {}

  /// I of n rows.
  static matrix identity(std::size_t n) {
    matrix eye(n, n);
    for (std::size_t i = 0; i < n; ++i) eye(i, i) = Real(1);
    return eye;
  }

  /// a_ij with i, j from 0, not checked.
  Real& operator()(std::size_t i, std::size_t j) { return data_[i * cols_ + j]; }
  /// The same of a constant matrix.
  const Real& operator()(std::size_t i, std::size_t j) const { return data_[i * cols_ + j]; }
  std::size_t rows() const { return rows_; }  ///< number of rows
  std::size_t cols() const { return cols_; }  ///< number of columns

 private:
  std::size_t rows_ = 0, cols_ = 0;
  std::vector<Real> data_;
};

/// The product ab; that a.cols() = b.rows() is not checked.
template <class Real>
matrix<Real> operator*(const matrix<Real>& a, const matrix<Real>& b) {
  matrix<Real> c(a.rows(), b.cols());
  for (std::size_t i = 0; i < a.rows(); ++i)
    for (std::size_t k = 0; k < a.cols(); ++k)
      for (std::size_t j = 0; j < b.cols(); ++j) c(i, j) += a(i, k) * b(k, j);
  return c;
}

/// The product ax; that a.cols() = x.size() is not checked.
template <class Real>
std::vector<Real> operator*(const matrix<Real>& a, const std::vector<Real>& x) {
  std::vector<Real> y(a.rows(), Real(0));
  for (std::size_t i = 0; i < a.rows(); ++i)
    for (std::size_t j = 0; j < a.cols(); ++j) y[i] += a(i, j) * x[j];
  return y;
}

/// Inverse of a lower triangular matrix with a nonzero diagonal, by forward substitution.
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
