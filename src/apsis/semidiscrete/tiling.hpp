#pragma once

#include <apsis/exec/parallel.hpp>
#include <apsis/mesh/grid.hpp>

#include <array>
#include <vector>

namespace apsis {

/// A mesh cut into boxes of cells. The sweeps along all directions change one box before the next one, so
/// that its states pass through the second-level cache only once.
class tiling {
 public:
  /// Cuts a line into `parts` parts of equal length with blocks of at most `longest` cells. Cuts a mesh of
  /// several dimensions into boxes of some hundred cells.
  tiling(const grid& mesh, int longest, int parts);

  /// Returns the number of boxes.
  int count() const;
  /// Returns the number of cells of the largest box.
  int most_cells() const { return most_cells_; }
  /// Returns box 0 … count() − 1; the last direction varies fastest. On a line the box may be empty.
  cell_box box(int number) const;

 private:
  std::array<std::vector<int>, 3> cuts_;  ///< first cells of the boxes along each direction, and the end
  int most_cells_ = 1;
};

}  // namespace apsis
