#pragma once

#include <apsis/boundary/tensor_axes.hpp>

#include <array>
#include <cstddef>
#include <span>

#include <boost/container/small_vector.hpp>

namespace apsis {

/// The exponentials exp(ν·φ) of velocities, φ = (1, c_1, …, c_d, ½|c|²), c = (v − ū)/σ. They are products of
/// factors for each axis, so that a table of them costs d n exponentials. Dimensionless.
class exponential_family {
 public:
  /// Numbers that belong to 1, c_1 … c_d, ½|c|²: the first d + 2.
  using vector = std::array<double, 5>;
  /// Numbers for each velocity of each axis.
  using table = boost::container::small_vector<double, 128>;  // not on the heap where it is usual

  /// Σ_j F_j exp(ν·φ_j) φ_j and Σ_j F_j exp(ν·φ_j) φ_j φ_jᵀ.
  struct sums {
    vector first{};                  ///< with one factor φ
    std::array<vector, 5> second{};  ///< with two
  };
  /// Multipliers of given sums.
  struct match {
    vector multipliers{};    ///< ν
    double total = 0.0;      ///< first of the sums
    bool is_solved = false;  ///< whether the sums are those that were wanted, to rounding
    int passes = 0;          ///< over the fluxes
  };

  /// Of velocities on `axes`, which must outlive the object, with the origin ū and the unit σ > 0.
  exponential_family(const tensor_axes& axes, const std::array<double, 3>& origin, double unit);

  /// factors ← the factors of every axis: exp(ν·φ) is their product. Returns whether all are moderate:
  /// finite, and more than 0 unless it is natural that they are 0.
  bool tabulate(const vector& multipliers, table& factors) const;
  /// Returns the largest |ν·φ| without the constant.
  double largest_exponent(const vector& multipliers) const;
  /// Returns the factor exp(ν·φ) that velocities of a line in the last direction have in common.
  double factor_of_line(const table& factors, const std::array<std::size_t, 3>& indices) const;
  /// Returns the factors of the last direction.
  const double* last(const table& factors) const { return factors.data() + offsets_[axes_.dimensions() - 1]; }
  /// Returns the sums with fluxes F_j, and with exp(ν·φ) from tabulate().
  sums sum(const double* flux, const table& factors) const;
  /// Returns ν with b·Σ F exp(ν·φ) φ = b·`wanted` for the vectors b of `basis`. `start` − ν is a combination
  /// of them. Newton's method minimizes the convex function Σ F exp(ν·φ) − ν·wanted, F ≥ 0. Steps are halved
  /// until it decreases. There is no solution where wanted is outside the cone of the φ with F > 0.
  match solve(const double* flux, const vector& wanted, std::span<const vector> basis,
              const vector& start) const;

 private:
  const tensor_axes& axes_;
  std::array<std::size_t, 3> offsets_{};
  table c_;  ///< (v − ū)/σ of every axis
};

}  // namespace apsis
