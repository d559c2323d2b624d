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
  /// Whole cell, or first cell of the group, behind it; −1 at ends, and for cells of other processes.
  int other = -1;
  bool is_image = false;                   ///< whether that lies across a periodic face
  std::array<double, 3> normal = {};       ///< unit vector out of the gas
  double rate = 0.0;                       ///< its area over the volume of the group
  std::array<double, 3> from_centre = {};  ///< vector to it from the centroid of the group
  int face = -1;                           ///< number of the open face in cut_cells; −1 at a wall
  /// At an end: where it is, for a boundary of the domain,
  std::optional<gas_end_of_segment> end = {};
  const oblique_wall* wall = nullptr;  ///< or the wall,
  wall_point at = {};                  ///< at this point

  /// Whether the gas ends here.
  bool is_end() const { return end.has_value() || wall != nullptr; }
};

/// A group of cut cells with its ways out.
struct group_of_cut {
  int cell = -1;                     ///< the first one, which stands for the group
  std::vector<int> others;           ///< those of this process whose rows are copies of its row
  double volume = 0.0;               ///< of the gas, over that of a whole cell
  std::vector<way_out_of_cut> ways;  ///< faces and walls
};

/// The groups of cut cells of a domain, for the sweeps and moment equations of steady states. A group in
/// the blocks of several processes belongs to the process of its first cell. Cells have the numbers of the
/// block of this process.
class cut_links {
 public:
  /// `space` must outlive the object. Without bodies there is no group.
  explicit cut_links(const domain& space);

  /// Returns the groups of this process, in the order of cut_cells.
  const std::vector<group_of_cut>& groups() const { return groups_; }
  /// Returns the number among them of the group of a cut cell; −1 for others.
  int group_of(int cell) const { return group_of_.empty() ? -1 : group_of_[at(cell)]; }
  /// Returns the cell whose row a cell has: the first one of its group.
  int first_of(int cell) const { return group_of(cell) < 0 ? cell : groups_[at(group_of(cell))].cell; }
  /// Copies the rows of groups to all of their cells, also to those of other processes. Collective.
  void copy_rows(field& u);

 private:
  /// A group of another process with cells of this one.
  struct group_of_others {
    int place;               ///< of its row among those received
    std::vector<int> cells;  ///< of this process
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

/// The components that leave a wall into the gas, as a map of rows. Has scratch memory: one object per
/// thread.
class wall_response {
 public:
  /// `velocities` must outlive the object.
  wall_response(const velocity_set& velocities, int stride);

  /// row ← `inside`, with what the wall emits for the components that leave it.
  void values_at(const way_out_of_cut& way, const double* inside, double* row);

 private:
  const velocity_set& velocities_;
  aligned_vector<double> inward_, emitted_;
};

}  // namespace apsis
