#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <utility>
#include <vector>

namespace apsis {

/// LU factors with partial pivoting of a matrix whose entries have −upper ≤ row − column ≤ lower: about
/// 2n lower (lower + upper) operations. Rows are stored with the places that pivoting fills.
template <class Real>
class band_factors {
 public:
  /// A matrix of n unknowns, all entries 0.
  band_factors(std::size_t n, std::size_t lower, std::size_t upper)
      : n_(n),
        lower_(lower),
        reach_(lower + upper),
        width_(lower + reach_ + 1),
        entries_(n * width_),
        scale_(n),
        pivots_(n) {}

  /// Sets all entries to 0.
  void clear() { std::fill(entries_.begin(), entries_.end(), Real(0)); }
  /// The entry in row i and column j of the band.
  Real& at(std::size_t i, std::size_t j) { return entries_[i * width_ + (j + lower_ - i)]; }
  Real at(std::size_t i, std::size_t j) const { return entries_[i * width_ + (j + lower_ - i)]; }

  /// Replaces the entries by the factors. Rows are scaled by powers of 2, so that their units do not
  /// influence the pivots.
  void factorize() {
    for (std::size_t i = 0; i < n_; ++i) scale_row(i);
    for (std::size_t j = 0; j < n_; ++j) {
      const std::size_t below = std::min(j + lower_, n_ - 1), right = std::min(j + reach_, n_ - 1);
      std::size_t pivot = j;
      for (std::size_t i = j + 1; i <= below; ++i)
        if (std::abs(at(i, j)) > std::abs(at(pivot, j))) pivot = i;
      pivots_[j] = pivot;
      if (pivot != j) std::swap_ranges(&at(j, j), &at(j, right) + 1, &at(pivot, j));
      const Real* from = &at(j, j);
      for (std::size_t i = j + 1; i <= below; ++i) {
        Real* to = &at(i, j);
        const Real factor = to[0] / from[0];
        to[0] = factor;
        if (factor == Real(0)) continue;
        for (std::size_t k = 1; k <= right - j; ++k) to[k] -= factor * from[k];
      }
    }
  }

  /// Sets x to the solution of the system with the right-hand side x; its numbers are not finite where the
  /// matrix is singular.
  void solve(std::span<Real> x) const {
    for (std::size_t i = 0; i < n_; ++i) x[i] *= scale_[i];
    for (std::size_t j = 0; j < n_; ++j) {
      std::swap(x[j], x[pivots_[j]]);
      for (std::size_t i = j + 1; i <= std::min(j + lower_, n_ - 1); ++i) x[i] -= at(i, j) * x[j];
    }
    for (std::size_t i = n_; i-- > 0;) {
      for (std::size_t k = i + 1; k <= std::min(i + reach_, n_ - 1); ++k) x[i] -= at(i, k) * x[k];
      x[i] /= at(i, i);
    }
  }

 private:
  void scale_row(std::size_t i) {
    const auto begin = entries_.begin() + static_cast<std::ptrdiff_t>(i * width_);
    const auto end = begin + static_cast<std::ptrdiff_t>(width_);
    Real largest(0);
    for (auto at = begin; at != end; ++at) largest = std::max(largest, std::abs(*at));
    scale_[i] = largest > Real(0) ? std::exp2(-std::round(std::log2(largest))) : Real(1);
    for (auto at = begin; at != end; ++at) *at *= scale_[i];
  }

  std::size_t n_, lower_, reach_, width_;  ///< reach_: columns right of the diagonal, after pivoting
  std::vector<Real> entries_, scale_;
  std::vector<std::size_t> pivots_;
};

}  // namespace apsis
