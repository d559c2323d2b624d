#pragma once

#include <apsis/boundary/domain.hpp>
#include <apsis/core/index.hpp>
#include <apsis/velocity/position.hpp>

#include <array>
#include <cstddef>
#include <vector>

namespace apsis {

/// Number of consecutive cells that a thread takes in loops over rows.
inline constexpr int cells_of_a_block = 16;

/// An end of a segment at a surface, with the cell in front of it.
struct gas_end_of_segment {
  face where;                  ///< upper if segments have their upper end here
  const boundary* side;        ///< boundary of the surface
  position at;                 ///< point at which the segment meets the surface
  std::array<int, 3> cells{};  ///< first cells inwards; a shorter segment repeats its last one
  double copied = 0.0;         ///< factor if a multiple of the row of the first cell enters; else 0
};

/// Neighbours of the cells of a domain along every direction, without cells of other processes. The first
/// cell of a group of cut cells stands for the group (cut_links), and no segment contains it. A group belongs
/// to the process of this cell.
class cell_links {
 public:
  /// Computes the links from all segments of the domain.
  explicit cell_links(const domain& space);

  /// Returns the next cell of the segment; −1 at its end, or if another process continues it.
  int next(int direction, bool upper, int cell) const { return next_[index(direction, upper)][at(cell)]; }
  /// Returns the next cell, also across periodic faces; −1 if the gas ends or another process continues it.
  int next_or_image(int direction, bool upper, int cell) const {
    return image_[index(direction, upper)][at(cell)];
  }
  /// Returns the number in ends() of the end next to a cell; −1 at a cell without one.
  int end_next_to(int direction, bool upper, int cell) const {
    return end_at_[index(direction, upper)][at(cell)];
  }
  /// Returns the first cell of the group of cut cells behind the end of a segment at a cell. Returns −1 at
  /// other ends, across periodic faces, and for groups of other processes.
  int cut_beyond(int direction, bool upper, int cell) const {
    return cut_at_.empty() ? -1 : cut_at_[index(direction, upper)][at(cell)];
  }
  /// Returns the volume of the gas of a cell or its group, relative to that of a whole cell.
  double volume(int cell) const { return volumes_.empty() ? 1.0 : volumes_[at(cell)]; }
  const std::vector<gas_end_of_segment>& ends() const { return ends_; }  ///< ends at walls and boundaries
  /// Returns the cells of the gas of this process in order. The first cell of a group of cut cells
  /// represents the group.
  const std::vector<int>& cells() const { return cells_; }
  int directions() const { return directions_; }  ///< directions of the mesh

 private:
  static std::size_t index(int direction, bool upper) { return face{direction, upper}.index(); }
  void link(const domain& space, int direction);
  void add_end(const domain& space, int direction, const segment& one, bool upper);
  void add_cells(const domain& space);
  void note_cut_cell(const domain& space, int direction, bool upper, int last);

  int directions_;
  std::vector<int> cells_;
  std::array<std::vector<int>, 6> next_, image_, end_at_;
  std::vector<std::vector<int>> cut_at_;  ///< empty without bodies
  std::vector<double> volumes_;           ///< empty without bodies
  std::vector<gas_end_of_segment> ends_;
};

}  // namespace apsis
