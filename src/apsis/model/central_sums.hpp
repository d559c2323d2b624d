#pragma once

#include <apsis/velocity/velocity_grid.hpp>

#include <array>
#include <cstddef>
#include <initializer_list>

namespace apsis {

/// Central moments Σ_j w_j g_j Π_k c_jk^p_k of a row g on a velocity grid, with c = v − u and Σ_k p_k ≤
/// degree. The sums run over one direction after the other. The order of sums does not depend on the
/// instruction set.
class central_sums {
 public:
  static constexpr int highest_degree = 4;       ///< largest possible degree
  using exponents = std::array<std::size_t, 3>;  ///< p_k; 0 for k ≥ grid.dimensions()

  /// Computes the moments of a row of grid.size() values about the velocity u, for degree ≤ highest_degree.
  central_sums(const velocity_grid& grid, const double* g, const double* u, int degree);

  /// Returns the moment with exponents p.
  double operator[](const exponents& p) const { return of_[p[0]][p[1]][p[2]]; }
  /// Returns the moment with exponents p[0], p[1], p[2].
  double operator()(const int* p) const {
    return of_[static_cast<std::size_t>(p[0])][static_cast<std::size_t>(p[1])]
              [static_cast<std::size_t>(p[2])];
  }
  /// Returns the moment of Π c_k over the given directions k, which may repeat.
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
