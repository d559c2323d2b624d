#pragma once

#include <apsis/mesh/face.hpp>
#include <apsis/mesh/grid.hpp>

#include <array>
#include <cstddef>
#include <vector>

namespace apsis {

/// An end of a segment: its place among the ends at one surface or, with surface −1, the number of the
/// segment that continues it across periodic faces.
struct segment_end {
  int surface = -1;  ///< number of the surface
  int place = 0;     ///< 0 … n−1 among the n ends at the surface, or a segment of the same direction
};

/// The cells of a pencil between two ends, without a solid cell in between. In a block of a mesh that several
/// processes share, the cells of this process; those of others continue them.
struct segment {
  int first = 0;                    ///< first cell
  int offset = 0;                   ///< its distance from the beginning of the pencil, in cells
  int cells = 0;                    ///< number of cells
  std::array<segment_end, 2> ends;  ///< the lower and the upper one, beyond the cells of others
  std::array<int, 2> beyond = {
      0, 0};  ///< number of cells of others before the lower and the upper end, as far as seen

  /// Whether an end lies at a cell of this process.
  bool ends_here(bool upper) const { return beyond[upper ? 1 : 0] == 0; }
};

/// A surface where segments end: a face of the grid, of a solid box or body, or the border to cut cells.
/// Cells of the gas lie on the side of it that `where` names as inside: `where.upper` if segments have their
/// upper end here.
struct surface {
  face where;                 ///< the end of the segments
  int solid = -1;             ///< grid::obstacle(); −1 for a face of the grid
  std::vector<int> segments;  ///< of the direction, in the order of segment_end::place
  int own = 0;                ///< number of these, the first ones, whose end lies at a cell of this process
};

/// The pencils of a grid, cut at solid and cut cells.
class segment_table {
 public:
  segment_table() = default;
  /// `periodic`: of each direction.
  segment_table(const grid& mesh, const std::array<bool, 3>& periodic);
  /// The segments of a block of a mesh, continued by at most `reach` cells of other blocks. Ends that are
  /// farther away have neither a surface nor a segment.
  segment_table(const grid& whole, const grid& block, const std::array<bool, 3>& periodic, int reach);

  /// Returns the segments of a direction, pencil by pencil.
  const std::vector<segment>& along(int direction) const {
    return along_[static_cast<std::size_t>(direction)];
  }
  /// Returns the number of the first segment of pencil 0 … n; pencil n, beyond the last one, has none.
  int first_of(int direction, int pencil) const {
    return first_of_[static_cast<std::size_t>(direction)][static_cast<std::size_t>(pencil)];
  }
  /// Returns the surfaces: the faces of the grid in the order of face::index(), without segments where they
  /// are periodic, then those of each solid box and body, and of the cut cells.
  const std::vector<surface>& surfaces() const { return surfaces_; }

 private:
  void cut(const grid& mesh, int direction);
  void link(int direction, bool periodic, const grid& mesh);
  void continue_beyond(const grid& whole, const grid& block, int direction, bool periodic, int reach);
  int surface_beyond(const grid& whole, const grid& block, int direction, bool periodic, int reach,
                     int number, bool upper);
  void end_at(int surface, int direction, int number, bool upper);

  std::array<std::vector<segment>, 3> along_;
  std::array<std::vector<int>, 3> first_of_;
  std::vector<surface> surfaces_;
};

}  // namespace apsis
