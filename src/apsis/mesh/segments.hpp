#pragma once

#include <apsis/mesh/face.hpp>
#include <apsis/mesh/grid.hpp>

#include <array>
#include <cstddef>
#include <vector>

namespace apsis {

/// An end of a segment, as a place among the ends at a surface. With surface −1, another segment continues
/// this one across periodic faces.
struct segment_end {
  int surface = -1;  ///< number of the surface
  int place = 0;     ///< 0 … n−1 among the n ends at the surface, or the number of the continuing segment
};

/// The cells of a pencil between two ends, with neither solid nor cut cells in between. In a block of a mesh
/// that several processes share, it has only the cells of this process. Cells of other processes may
/// continue it.
struct segment {
  int first = 0;                    ///< first cell
  int offset = 0;                   ///< distance of the first cell from the beginning of the pencil, in cells
  int cells = 0;                    ///< number of cells
  std::array<segment_end, 2> ends;  ///< lower and upper end, beyond the cells of other processes
  std::array<int, 2> beyond = {0, 0};  ///< cells of others up to each end

  /// Whether the lower or upper end lies at a cell of this process.
  bool ends_here(bool upper) const { return beyond[upper ? 1 : 0] == 0; }
};

/// A surface where segments end: a face of the grid, of a solid box or of a body, or the border to cut cells.
/// `where.upper` is true if segments have their upper end here; the gas is then below the surface.
struct surface {
  face where;                 ///< direction and end of the segments
  int solid = -1;             ///< grid::obstacle(); −1 for a face of the grid
  std::vector<int> segments;  ///< segments of the direction, in the order of segment_end::place
  int own = 0;                ///< number of leading segments whose end lies at a cell of this process
};

/// The pencils of a grid, cut at solid and cut cells.
class segment_table {
 public:
  segment_table() = default;
  /// Divides the pencils of a whole mesh. `periodic` has a flag for each direction.
  segment_table(const grid& mesh, const std::array<bool, 3>& periodic);
  /// Divides the pencils of a block of a mesh. Segments may continue by at most `reach` cells of other
  /// blocks. Ends that are farther away have neither a surface nor a segment (both numbers are −1).
  segment_table(const grid& whole, const grid& block, const std::array<bool, 3>& periodic, int reach);

  /// Returns the segments of a direction, pencil by pencil.
  const std::vector<segment>& along(int direction) const {
    return along_[static_cast<std::size_t>(direction)];
  }
  /// Returns the number of the first segment of pencil 0 … n. For pencil n, beyond the last one, it is the
  /// number of segments.
  int first_of(int direction, int pencil) const {
    return first_of_[static_cast<std::size_t>(direction)][static_cast<std::size_t>(pencil)];
  }
  /// Returns all surfaces. The faces of the grid come first, in the order of face::index(); periodic ones
  /// have no segments. The surfaces of each solid box and body follow, then those of the cut cells.
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
