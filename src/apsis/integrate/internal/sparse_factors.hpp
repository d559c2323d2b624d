#pragma once

#include <apsis/integrate/internal/stage_system.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include <Eigen/SparseCore>
#include <Eigen/SparseLU>

namespace apsis {

/// A matrix of fixed pattern, its scales and its factors.
template <class Real>
class sparse_factors {
  using column = Eigen::Matrix<Real, Eigen::Dynamic, 1>;

 public:
  using matrix = Eigen::SparseMatrix<Real, Eigen::ColMajor, int>;  ///< type of the matrix
  matrix entries;  ///< the matrix; its places stay those of the first factorization

  void factorize() {
    equilibrate();
    scaled_ = entries;
    for_each_of(scaled_, [&](int i, int j, Real& value) { value *= rows_[i] * cols_[j]; });
    if (!ordered_) lu_.analyzePattern(scaled_);
    ordered_ = true;
    lu_.factorize(scaled_);
  }
  /// Returns the solution; +infinity if the matrix is singular.
  column solve(const column& r) const {
    if (lu_.info() != Eigen::Success)
      return column::Constant(r.size(), std::numeric_limits<Real>::infinity());
    const column y = lu_.solve(rows_.cwiseProduct(r));
    return cols_.cwiseProduct(y);
  }
  /// An estimate of 1/(|S| |S⁻¹|) for the scaled matrix S in maximum norms, within the factor n; 0 if it is
  /// singular. Scales and units do not enter.
  Real reciprocal_condition() const {
    if (lu_.info() != Eigen::Success) return Real(0);
    const Eigen::Index n = scaled_.rows();
    Real largest(0);
    std::uint64_t bits = 0x9e3779b97f4a7c15u;
    column signs(n);
    for (int probe = 0; probe < 6; ++probe) {
      for (Eigen::Index i = 0; i < n; ++i) {
        bits ^= bits << 13, bits ^= bits >> 7, bits ^= bits << 17;
        signs[i] = (bits >> 40 & 1u) != 0 ? Real(1) : Real(-1);
      }
      const Real size = column(lu_.solve(signs)).template lpNorm<Eigen::Infinity>();
      if (!std::isfinite(size)) return Real(0);
      largest = std::max(largest, size);
    }
    const column ones = column::Ones(n);
    return Real(1) / (largest * column(scaled_.cwiseAbs() * ones).template lpNorm<Eigen::Infinity>());
  }

 private:
  /// Chooses powers of 2 that bring the largest entries of rows and columns near 1.
  void equilibrate() {
    rows_ = cols_ = column::Ones(entries.rows());
    column largest(entries.rows());
    const auto invert = [&](column& scales) {
      for (Eigen::Index i = 0; i < scales.size(); ++i)
        scales[i] = largest[i] > Real(0) ? stage_system<Real>::power_of_2(Real(1) / largest[i]) : Real(1);
    };
    for (int sweep = 0; sweep < 3; ++sweep) {
      largest.setZero();
      for_each_of(entries, [&](int i, int j, Real& value) {
        largest[i] = std::max(largest[i], std::abs(value) * cols_[j]);
      });
      invert(rows_);
      largest.setZero();
      for_each_of(entries, [&](int i, int j, Real& value) {
        largest[j] = std::max(largest[j], std::abs(value) * rows_[i]);
      });
      invert(cols_);
    }
  }

  /// Calls body(row, column, value) for every entry.
  template <class Body>
  static void for_each_of(matrix& of, const Body& body) {
    for (int j = 0; j < of.outerSize(); ++j)
      for (typename matrix::InnerIterator at(of, j); at; ++at)
        body(static_cast<int>(at.row()), j, at.valueRef());
  }

  matrix scaled_;
  column rows_, cols_;
  Eigen::SparseLU<matrix, Eigen::COLAMDOrdering<int>> lu_;
  bool ordered_ = false;
};

}  // namespace apsis
