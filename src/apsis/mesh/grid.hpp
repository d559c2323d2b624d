#pragma once

#include <apsis/core/errors.hpp>
#include <apsis/core/index.hpp>
#include <apsis/mesh/face.hpp>
#include <apsis/velocity/position.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <memory>
#include <numbers>
#include <vector>

namespace apsis {

class cut_cells;

/// Cells first … first + cells − 1 of each direction.
struct cell_box {
  std::array<int, 3> first = {0, 0, 0},              ///< first cell of each direction
      cells = {1, 1, 1};                             ///< numbers of cells
  bool operator==(const cell_box&) const = default;  ///< equal cells
};

/// Cells begin … end−1.
struct cell_range {
  int begin;  ///< first cell
  int end;    ///< one past the last cell
};

/// Calls body(first, last) for the parts of `ranges` within the cells begin … end−1. `ranges` must increase;
/// `last` is one past the last cell.
template <class Body>
void for_cells_in(const std::vector<cell_range>& ranges, int begin, int end, const Body& body) {
  auto one = std::upper_bound(ranges.begin(), ranges.end(), begin,
                              [](int cell, const cell_range& range) { return cell < range.end; });
  for (; one != ranges.end() && one->begin < end; ++one)
    body(std::max(begin, one->begin), std::min(end, one->end));
}

/// Uniform cells on a box in D = 1, 2 or 3 dimensions, with the last direction fastest. Unused directions
/// have one cell. Boxes of cells may be solid, and bodies may cut cells. Solid cells have numbers, but no
/// gas. A grid may be a block of a larger grid. Its cell numbers are then local, and its coordinates equal
/// those of the larger grid bit for bit. Lengths are dimensionless.
class grid {
 public:
  /// Largest number of cells, so that cell numbers, including ghost cells, fit into int.
  static constexpr int most_cells = 1 << 30;

  /// Makes a grid from the numbers of cells and the ends of the box in each direction. Throws input_error
  /// unless 1 ≤ D ≤ 3, every direction has at least one cell and a positive, finite length, and there are at
  /// most most_cells cells.
  grid(int dimensions, std::array<int, 3> cells, std::array<double, 3> lower, std::array<double, 3> upper);
  /// Returns a grid on the interval [a, b].
  static grid line(int cells, double a, double b) { return grid(1, {cells, 1, 1}, {a, 0, 0}, {b, 1, 1}); }

  /// Returns the block of `cells` cells that begins at cell `first` of this grid, in each direction. Throws
  /// input_error unless the block has cells and lies inside.
  grid block(std::array<int, 3> first, std::array<int, 3> cells) const;

  /// Returns this grid with solid boxes, which may overlap. Throws input_error unless every box has cells and
  /// lies inside, and some cell is not solid.
  grid with_solids(std::vector<cell_box> boxes) const;

  /// Returns this grid with the cells that bodies cut. Throws input_error if this grid already has bodies or
  /// is a block of a larger grid, and if `cut` was made for a grid with other cells or solid boxes.
  grid with_cut_cells(std::shared_ptr<const cut_cells> cut) const;

  /// Returns whether this is a block() with some of the cells of a larger grid.
  bool is_block() const { return cells_ != whole_cells_; }
  /// Returns whether both grids have the same cells and solid boxes.
  bool has_cells_of(const grid& other) const;

  /// Returns this grid for axisymmetric flow, in the half-plane (x, r) or on a line r with the axis r = 0.
  /// Unknowns are r f. Their integral over a cell, times 2π, is the integral of f over the ring of the cell.
  /// Throws input_error unless 1 ≤ D ≤ 2 and r ≥ 0.
  grid about_axis() const;

  int dimensions() const { return dimensions_; }  ///< D
  bool has_axis() const { return has_axis_; }     ///< whether this is a grid about_axis()
  /// Returns the factor that turns integrals of the unknown over cells into integrals over space: 2π about an
  /// axis, else 1.
  double measure() const { return has_axis_ ? 2.0 * std::numbers::pi : 1.0; }
  /// Returns the number of lengths in the dimension of integrals over space: D, or D + 1 about an axis.
  int dimensions_of_integrals() const { return dimensions_ + (has_axis_ ? 1 : 0); }
  /// Returns the factor of f in the unknown: the distance r of a point from the axis, or 1 without an axis.
  double radius(const position& x) const { return has_axis_ ? x[at(dimensions_ - 1)] : 1.0; }
  int cells(int direction) const {
    return cells_[at(direction)];
  }  ///< number of cells along a direction 0, 1 or 2
  int size() const { return cells_[0] * cells_[1] * cells_[2]; }           ///< total number of cells
  int first(int direction) const { return first_[at(direction)]; }         ///< global number of local cell 0
  double spacing(int direction) const { return spacing_[at(direction)]; }  ///< Δx along a direction
  double cell_volume() const;                                              ///< Π Δx over the D directions
  /// Returns the area of a face of a cell: 1 in one dimension.
  double face_area(const face& where) const { return cell_volume() / spacing(where.direction); }
  /// Returns the coordinate of the lower edge of cell 0 … n along a direction. Cells are counted along
  /// this direction.
  double edge(int direction, int cell) const {
    return lower_[at(direction)] + spacing(direction) * (first(direction) + cell);
  }
  /// Returns the coordinate of the centre of a cell along a direction.
  double centre(int cell, int direction) const;
  /// Returns the centre of a cell. For a cut cell it is the centroid of the gas of its group.
  position centre(int cell) const;
  /// Returns the distance in cell numbers between neighbours along a direction.
  int stride(int direction) const;

  /// Returns the number in this grid of a cell of `block`, which must be a block of this grid.
  int cell_of(const grid& block, int cell) const;

  /// Returns the number of pencils along a direction. A pencil is a line of cells(direction) cells whose
  /// numbers are stride(direction) apart.
  int pencils(int direction) const { return size() / cells(direction); }
  /// Returns the first cell of pencil 0 … pencils(direction) − 1.
  int first_cell(int direction, int pencil) const;

  const std::vector<cell_box>& solids() const { return solids_; }  ///< solid boxes
  /// Returns the obstacle that contains a cell; −1 in the gas. For a solid box it is the number of the
  /// box, the last one if several contain the cell. For a body it is the number of boxes plus the number
  /// of the body.
  int solid(int cell) const { return solid_ ? (*solid_)[at(cell)] : -1; }
  /// Returns the number of solid boxes and bodies.
  int obstacles() const { return static_cast<int>(solids_.size()) + bodies_; }
  /// Returns the cut cells of the whole mesh; null without bodies.
  const cut_cells* cut() const { return cut_.get(); }
  /// Returns the number of the group of a cut cell among cut_cells::groups(); −1 for other cells.
  int cut_group(int cell) const { return group_ ? (*group_)[at(cell)] : -1; }
  /// Returns the obstacle at which segments end before a cell: solid(cell), or obstacles() for a cut cell; −1
  /// for a whole cell of gas.
  int obstacle(int cell) const { return cut_group(cell) >= 0 ? obstacles() : solid(cell); }
  /// Returns the share of gas in the volume of a cell that is not solid.
  double gas_share(int cell) const;
  /// Returns all cells that are not solid, in increasing order. A block() without such cells has a single
  /// empty range.
  const std::vector<cell_range>& fluid() const { return fluid_; }

 private:
  void check_size() const;
  void set_solids(std::vector<cell_box> boxes);
  void copy_bodies(const grid& whole);
  void find_fluid();

  int dimensions_;
  bool has_axis_ = false;
  std::array<int, 3> cells_, first_,
      whole_cells_;  ///< numbers of cells of the larger grid, or of this one
  std::array<double, 3> lower_, spacing_;
  std::vector<cell_box> solids_;
  int bodies_ = 0;
  std::shared_ptr<const cut_cells> cut_;     ///< cut cells of the whole mesh
  std::shared_ptr<const grid> whole_;        ///< mesh of the cut cells
  std::shared_ptr<std::vector<int>> solid_,  ///< solid() of every cell; null without obstacles
      group_;                                ///< cut_group() of every cell; null without bodies
  std::vector<cell_range> fluid_;
};

}  // namespace apsis
