#pragma once

#include <apsis/exec/aligned.hpp>

#include <memory>
#include <span>
#include <vector>

namespace apsis {

/// Discrete velocities v_j ∈ ℝ^d, j = 0 … n−1, with quadrature weights w_j. A row has one or more sets of
/// components on them. Component s n + j of a row is transported with v_j, s = 0 … sets−1. Immutable; copies
/// share their numbers. Dimensionless.
class velocity_set {
 public:
  /// Makes an empty set, for equations without space.
  velocity_set();
  /// coordinates[k][j] is component k of v_j. Throws input_error unless there are 1 to 3 rows of coordinates,
  /// each as long as `weights`. All numbers must be finite, weights ≥ 0 and sets ≥ 1.
  velocity_set(std::vector<aligned_vector<double>> coordinates, std::vector<double> weights, int sets = 1);

  int dimensions() const;                             ///< d; 0 without velocities
  int size() const;                                   ///< n
  int sets() const;                                   ///< number of sets of components
  int components() const { return sets() * size(); }  ///< numbers of a row
  /// Returns the velocity of every component along direction k, components() numbers; empty for k ≥ d.
  std::span<const double> speeds(int k) const;
  /// Returns the weights w_j, size() numbers.
  std::span<const double> weights() const;

 private:
  struct numbers;
  std::shared_ptr<const numbers> numbers_;
};

}  // namespace apsis
