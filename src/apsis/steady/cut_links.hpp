#pragma once

#include <apsis/boundary/domain.hpp>
#include <apsis/boundary/oblique_wall.hpp>
#include <apsis/mesh/cut_cells.hpp>
#include <apsis/mesh/shared_rows.hpp>
#include <apsis/steady/cell_links.hpp>

#include <array>
#include <memory>
#include <optional>
#include <vector>

namespace apsis {

/// A face or a piece of wall through which the gas of a group of cut cells leaves.
struct way_out_of_cut {
  /// The whole cell behind it, or the first cell of the group behind it; −1 at ends and for cells
  /// of other processes.
  int other = -1;
  bool is_image = false;                   ///< whether `other` lies across a periodic face
  std::array<double, 3> normal = {};       ///< unit vector out of the gas
  double rate = 0.0;                       ///< area of the face or wall over the volume of the group
  std::array<double, 3> from_centre = {};  ///< vector to it from the centroid of the group
  int face = -1;                           ///< number of the open face in cut_cells; −1 at a wall
  /// The end of the gas, if it ends at a boundary of the domain.
  std::optional<gas_end_of_segment> end = {};
  const oblique_wall* wall = nullptr;  ///< the wall, if the gas ends at a wall; else null
  wall_point at = {};                  ///< point of the wall

  /// Returns true if the gas ends here.
  bool is_end() const { return end.has_value() || wall != nullptr; }
};

/// A group of cut cells with its ways out.
struct group_of_cut {
  int cell = -1;                     ///< first cell of the group, which stands for the group
  std::vector<int> others;           ///< other cells of this process, with copies of its row
  double volume = 0.0;               ///< volume of the gas over that of a whole cell
  std::vector<way_out_of_cut> ways;  ///< faces and walls
};

/// The groups of cut cells of a domain, for the sweeps and moment equations of steady states. A group in the
/// blocks of several processes belongs to the process of its first cell. Cell numbers are those of the block
/// of this process.
class cut_links {
 public:
  /// `space` must outlive the object. Without bodies there is no group.
  explicit cut_links(const domain& space);

  /// Returns the groups of this process, in the order of cut_cells.
  const std::vector<group_of_cut>& groups() const { return groups_; }
  /// Returns the number in groups() of the group of a cut cell; −1 for other cells.
  int group_of(int cell) const { return group_of_.empty() ? -1 : group_of_[at(cell)]; }
  /// Returns the cell with the row of a cell: the first one of its group, or the cell itself.
  int first_of(int cell) const { return group_of(cell) < 0 ? cell : groups_[at(group_of(cell))].cell; }
  /// Copies the rows of groups to all of their cells, including those of other processes. Collective.
  void copy_rows(field& u);

 private:
  /// A group of another process that has cells of this one.
  struct group_of_others {
    int place;               ///< place of its row among the received ones
    std::vector<int> cells;  ///< its cells of this process
  };

  void add_group(const domain& space, int number);
  void share_groups(const domain& space);

  const domain* space_;
  std::vector<std::shared_ptr<const oblique_wall>> walls_;  ///< of boxes and bodies
  std::vector<int> group_of_;
  std::vector<group_of_cut> groups_;
  std::vector<group_of_others> others_;
  shared_rows rows_;  ///< by the first cell of a group in the whole mesh
};

/// The components that leave a wall into the gas, as a map of rows. An object has scratch memory and serves
/// a single thread.
class wall_response {
 public:
  /// `velocities` must outlive the object.
  wall_response(const velocity_set& velocities, int stride);

  /// row[k] ← the emission of the wall for components that leave the wall, and inside[k] for others.
  void values_at(const way_out_of_cut& way, const double* inside, double* row);

 private:
  const velocity_set& velocities_;
  aligned_vector<double> inward_, emitted_;
};

}  // namespace apsis
