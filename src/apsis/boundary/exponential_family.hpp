#pragma once

#include <apsis/boundary/tensor_axes.hpp>

#include <array>
#include <cstddef>
#include <span>

#include <boost/container/small_vector.hpp>

namespace apsis {

/// The exponentials exp(ν·φ) of velocities with φ = (1, c_1, …, c_d, ½|c|²) and c = (v − ū)/σ.
/// They are products of one factor for each axis, so that a table for n velocities per axis needs
/// d n exponentials. Dimensionless.
class exponential_family {
 public:
  /// Coefficients of 1, c_1, …, c_d, ½|c|²; the first d + 2 are used.
  using vector = std::array<double, 5>;
  /// One number for each velocity of each axis.
  using table = boost::container::small_vector<double, 128>;  // usual sizes need no heap

  /// The sums Σ_j F_j exp(ν·φ_j) φ_j and Σ_j F_j exp(ν·φ_j) φ_j φ_jᵀ.
  struct sums {
    vector first{};                  ///< sums with one factor φ
    std::array<vector, 5> second{};  ///< sums with two factors φ
  };
  /// The multipliers ν that solve() found.
  struct match {
    vector multipliers{};    ///< ν
    double total = 0.0;      ///< Σ_j F_j exp(ν·φ_j)
    bool is_solved = false;  ///< whether the sums equal the wanted ones to rounding
    int passes = 0;          ///< number of passes over the fluxes
  };

  /// Uses the velocities on `axes`, which must outlive the object, with the origin ū and the unit σ > 0.
  exponential_family(const tensor_axes& axes, const std::array<double, 3>& origin, double unit);

  /// factors ← the factors of every axis, with the product exp(ν·φ). Returns true if no exponent is so large
  /// that a factor might overflow; factors may underflow to 0.
  bool tabulate(const vector& multipliers, table& factors) const;
  /// Returns an upper bound of |ν·φ| without the constant term: the sum of the largest values along the axes.
  double largest_exponent(const vector& multipliers) const;
  /// Returns the common factor of exp(ν·φ) for the velocities of a line in the last direction. `indices` are
  /// the positions of the line on the other axes.
  double factor_of_line(const table& factors, const std::array<std::size_t, 3>& indices) const;
  /// Returns the factors of the last axis.
  const double* last(const table& factors) const { return factors.data() + offsets_[axes_.dimensions() - 1]; }
  /// Returns the sums with fluxes F_j and the factors of tabulate().
  sums sum(const double* flux, const table& factors) const;
  /// Returns ν with b·Σ F exp(ν·φ) φ = b·`wanted` for every vector b of `basis`; ν − `start` is a combination
  /// of these vectors. Newton's method minimizes the convex function Σ F exp(ν·φ) − ν·wanted, F ≥ 0. Steps
  /// are halved until this function decreases. There is no solution if `wanted` is outside the cone of the φ
  /// with F > 0.
  match solve(const double* flux, const vector& wanted, std::span<const vector> basis,
              const vector& start) const;

 private:
  const tensor_axes& axes_;
  std::array<std::size_t, 3> offsets_{};
  table c_;  ///< (v − ū)/σ of every axis
};

}  // namespace apsis
