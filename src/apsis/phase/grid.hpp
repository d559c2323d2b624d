#pragma once

#include <apsis/core/errors.hpp>

#include <array>
#include <cstddef>

namespace apsis {

/// A point of space; coordinates beyond the dimensions of the mesh are 0.
using position = std::array<double, 3>;

/// Uniform cells on a box in D = 1, 2 or 3 dimensions, the last direction fastest. Unused directions have one
/// cell. Dimensionless lengths.
class grid {
 public:
  /// Most cells of a mesh: with those beyond its ends their numbers are ints.
  static constexpr int most_cells = 1 << 30;

  /// Throws input_error unless every used direction has ≥ 1 cells and a domain of positive, finite length,
  /// and all together have at most most_cells.
  grid(int dimensions, std::array<int, 3> cells, std::array<double, 3> lower, std::array<double, 3> upper);
  /// The interval [a, b].
  static grid line(int cells, double a, double b) { return grid(1, {cells, 1, 1}, {a, 0, 0}, {b, 1, 1}); }

  int dimensions() const { return dimensions_; }                           ///< D
  int cells(int direction) const { return cells_[at(direction)]; }         ///< along a direction 0, 1 or 2
  int size() const { return cells_[0] * cells_[1] * cells_[2]; }           ///< number of all cells
  double spacing(int direction) const { return spacing_[at(direction)]; }  ///< Δx along a direction
  double cell_volume() const;                                              ///< product of the D spacings
  /// Centre of cell number `cell` along `direction`.
  double centre(int cell, int direction) const;
  /// Centre of cell number `cell`.
  position centre(int cell) const;
  /// Distance in cell numbers between neighbours along `direction`.
  int stride(int direction) const;

  /// Pencils along a direction: lines of cells(direction) cells, stride(direction) apart.
  int pencils(int direction) const { return size() / cells(direction); }
  /// Number of the first cell of pencil 0 … pencils(direction) − 1.
  int first_cell(int direction, int pencil) const;

 private:
  void check_size() const;
  static std::size_t at(int direction) { return static_cast<std::size_t>(direction); }

  int dimensions_;
  std::array<int, 3> cells_;
  std::array<double, 3> lower_, spacing_;
};

}  // namespace apsis
