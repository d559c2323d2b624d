#pragma once

#include <apsis/velocity/velocity_grid.hpp>

#include <array>
#include <cstddef>
#include <initializer_list>

namespace apsis {

/// Central moments Σ_j w_j g_j Π_k c_jk^p_k, c = v − u, of a row g on a velocity grid, Σ_k p_k ≤ degree. The
/// directions are summed one after the other. The order of sums does not depend on the instruction set.
class central_sums {
 public:
  static constexpr int highest_degree = 4;       ///< of all moments
  using exponents = std::array<std::size_t, 3>;  ///< p_k, 0 from the dimensions of the grid on

  /// Computes those up to a degree of at most highest_degree.
  central_sums(const velocity_grid& grid, const double* g, const double* u, int degree);

  /// Returns the moment with some exponents.
  double operator[](const exponents& p) const { return of_[p[0]][p[1]][p[2]]; }
  /// Returns the moment with exponents p_1 … p_3.
  double operator()(const int* p) const {
    return of_[static_cast<std::size_t>(p[0])][static_cast<std::size_t>(p[1])]
              [static_cast<std::size_t>(p[2])];
  }
  /// Returns the moment of the product of c_k for some directions k.
  double along(std::initializer_list<std::size_t> directions) const {
    exponents p{};
    for (const std::size_t k : directions) ++p[k];
    return (*this)[p];
  }

 private:
  template <class Powers>
  void add(const velocity_grid& grid, const double* g, const double* u, int degree);
  void add_on_rings(const velocity_grid& grid, const double* g, const double* u, int degree);

  static constexpr std::size_t size = highest_degree + 1;
  std::array<std::array<std::array<double, size>, size>, size> of_{};
};

}  // namespace apsis
