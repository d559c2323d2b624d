#pragma once

#include <apsis/integrate/sparsity_pattern.hpp>

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace apsis {

/// A constant, invertible matrix M of a system M u' = F(t, u) + G(t, u), with its factors. Finite elements
/// and moving coordinates lead to such systems; all numbers are dimensionless. Copies share the factors.
/// Instantiated for double and long double.
template <class Real>
class mass_matrix {
 public:
  /// An entry of M.
  struct entry {
    std::size_t row,  ///< its row, from 0
        column;       ///< its column, from 0
    Real value;       ///< its value
  };

  /// The n × n matrix with these entries; values at the same place are added. Throws input_error for n = 0, a
  /// place outside, a number that is not finite, and a matrix that is singular to working precision: its
  /// system contains an algebraic equation.
  mass_matrix(std::size_t n, const std::vector<entry>& entries);
  /// The same for all n² numbers, row by row.
  static mass_matrix full(std::size_t n, std::span<const Real> rows);

  std::size_t size() const;  ///< n
  /// Places of the entries, in the order of columns.
  const std::vector<sparsity_pattern::place>& places() const;
  /// Sets y ← M x; x and y do not overlap.
  void multiply(std::span<const Real> x, std::span<Real> y) const;
  /// Sets y ← |M| x with the absolute values of the entries; x and y do not overlap.
  void multiply_sizes(std::span<const Real> x, std::span<Real> y) const;
  /// Sets x ← M⁻¹ x.
  void divide(std::span<Real> x) const;
  /// All n² numbers, column by column.
  std::vector<Real> columns() const;
  /// The entries at the places of a pattern that contains all of theirs, in its order; 0 where M has none.
  std::vector<Real> at(const sparsity_pattern& pattern) const;

 private:
  struct parts;
  std::shared_ptr<const parts> parts_;
};

/// Returns the entries of M, or of the unit matrix for null, at the places of a pattern that contains theirs.
template <class Real>
std::vector<Real> masses_at(const sparsity_pattern& pattern, const mass_matrix<Real>* mass) {
  if (mass != nullptr) return mass->at(pattern);
  std::vector<Real> ones;
  for (std::size_t j = 0; j < pattern.size(); ++j)
    for (const std::size_t i : pattern.rows(j)) ones.push_back(i == j ? Real(1) : Real(0));
  return ones;
}

}  // namespace apsis
