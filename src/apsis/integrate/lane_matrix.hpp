#pragma once

#include <apsis/integrate/lanes.hpp>

#include <array>
#include <cstddef>

namespace apsis {

/// Eight matrices of N × N numbers side by side. LU factors with row exchanges solve their linear systems
/// (partial pivoting: Golub, Van Loan, Matrix Computations, section 3.4). Every lane chooses its own
/// exchanges. A singular matrix gives numbers that are not finite, in its lane only.
template <std::size_t N>
class lane_matrix {
 public:
  /// The entry in a row and a column, before factorize().
  lanes& operator()(std::size_t row, std::size_t column) { return of_[row][column]; }

  /// Replaces the matrix by its factors.
  void factorize() {
    std::size_t next = 0;
    for (std::size_t c = 0; c < N; ++c) {
      for (std::size_t i = c + 1; i < N; ++i) {
        exchanges_[next] = where_larger(of_[c][c], of_[i][c]);
        for (std::size_t j = 0; j < N; ++j) exchange(exchanges_[next], of_[c][j], of_[i][j]);
        ++next;
      }
      of_[c][c] = lanes(1.0) / of_[c][c];
      for (std::size_t i = c + 1; i < N; ++i) {
        of_[i][c] *= of_[c][c];
        for (std::size_t j = c + 1; j < N; ++j) of_[i][j] -= of_[i][c] * of_[c][j];
      }
    }
  }

  /// Sets the matrix to the factors of I − a J.
  void factorize_shifted(double a, const std::array<std::array<lanes, N>, N>& jacobian) {
    for (std::size_t i = 0; i < N; ++i) {
      for (std::size_t j = 0; j < N; ++j) of_[i][j] = lanes(-a) * jacobian[i][j];
      of_[i][i] += 1.0;
    }
    factorize();
  }

  /// r ← A⁻¹ r. Requires factors.
  void solve(std::array<lanes, N>& r) const {
    std::size_t next = 0;
    for (std::size_t c = 0; c < N; ++c)
      for (std::size_t i = c + 1; i < N; ++i) exchange(exchanges_[next++], r[c], r[i]);
    for (std::size_t c = 0; c < N; ++c)
      for (std::size_t i = c + 1; i < N; ++i) r[i] -= of_[i][c] * r[c];
    for (std::size_t c = N; c-- > 0;) {
      for (std::size_t j = c + 1; j < N; ++j) r[c] -= of_[c][j] * r[j];
      r[c] *= of_[c][c];
    }
  }

 private:
  std::array<std::array<lanes, N>, N> of_;
  std::array<lanes::choice, N*(N - 1) / 2 + 1> exchanges_;
};

}  // namespace apsis
