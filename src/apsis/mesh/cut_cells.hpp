#pragma once

#include <apsis/core/index.hpp>
#include <apsis/mesh/grid.hpp>
#include <apsis/velocity/position.hpp>

#include <array>
#include <functional>
#include <unordered_map>
#include <vector>

namespace apsis {

/// A continuous function φ of space with φ > 0 in the gas and φ ≤ 0 in a body.
using outside_function = std::function<double(const position&)>;

/// The open part of a face between two cells with different unknowns, or of a face of the domain. At least
/// one of the cells is cut.
struct open_face {
  int below = -1,                      ///< cell on the lower side; −1 beyond the domain
      above = -1;                      ///< cell on the upper side; −1 beyond the domain
  int direction = 0;                   ///< direction of the normal
  double area = 0.0;                   ///< area of the open part; a length in two dimensions
  position middle = {};                ///< centroid of the open part
  position from_below = {},            ///< vector to `middle` from the centroid of the gas below
      from_above = {};                 ///< vector to `middle` from the centroid of the gas above
  std::vector<position> corners = {};  ///< at a face of the domain, like wall_segment::corners
};

/// A flat piece of wall in a cut cell.
struct wall_segment {
  int cell = -1;                      ///< cell whose gas it bounds
  int solid = -1;                     ///< number of the solid box or body; boxes come first
  double area = 0.0;                  ///< area of the piece; a length in two dimensions
  std::array<double, 3> normal = {};  ///< unit vector into the gas
  position middle = {};               ///< point on the wall
  /// ∫ (x − middle) × n dA / area with n into the gas: the moment of a uniform pressure about `middle`. The
  /// total moments of a uniform pressure on all pieces of a body are then 0 to rounding.
  std::array<double, 3> moment = {};
  position from_centre = {};  ///< vector to `middle` from the centroid of the gas
  /// Corners of the piece. In two dimensions these are its ends, with the solid on the left of the way from
  /// the first to the second. In three dimensions they form a polygon, counter-clockwise seen from the gas.
  /// Their vector area is area × normal to rounding. Corners that pieces of a body share have equal bits.
  std::vector<position> corners = {};
};

/// Cut cells that share one unknown: a single cell, or a small cell with its neighbours.
struct cut_group {
  std::vector<int> cells;  ///< in increasing order
  double volume = 0.0;     ///< volume of the gas in them; an area in two dimensions
  position centre = {};    ///< centroid of the gas, on the side of the first cell at periodic faces
  std::vector<int> faces,  ///< numbers of its open faces
      walls;               ///< numbers of its wall segments
};

/// The cells of a mesh that bodies cut: volumes of gas, open parts of faces and pieces of wall. The sum of
/// area × normal over the walls and faces of a group is 0 to rounding, so that a uniform gas stays uniform.
/// Both cells of a face use the same area. All other cells of the gas are whole: no face of theirs is
/// partly open.
///
/// Small cells join their neighbours across the largest open faces until
///     κ max_k max_± Δx_k Σ_out area / volume ≤ 1
/// holds for every group. The sum runs over the faces and walls through which a motion along ±x_k leaves the
/// group. A step of Δt ≤ κ / max Σ_k |v_k|/Δx_k then empties no cell. Indeed, the outflow is a convex
/// function of the velocity. Under the condition Σ_k |v_k|/Δx_k = 1, it has its maximum on an axis.
///
/// Lengths are dimensionless.
class cut_cells {
 public:
  /// The CFL number κ. Larger values join more cells. For κ = 1, the cells along a wall would have to
  /// join endlessly.
  static constexpr double cfl_number = 0.5;

  /// Cuts a mesh of two or three dimensions, which may have solid boxes. `bodies` has the function φ of each
  /// body, `periodic` a flag for each direction. Throws input_error if
  /// - φ is not finite at a corner of a cell;
  /// - a body crosses a periodic face and does not continue at the opposite one;
  /// - a gap between bodies, or most of a body, is thinner than a cell (the message suggests space.cells);
  /// - a body lies between the corners of the cells;
  /// - no cell of gas is left.
  cut_cells(const grid& mesh, const std::vector<outside_function>& bodies,
            const std::array<bool, 3>& periodic);

  /// Returns the mesh that is cut, without the bodies.
  const grid& mesh() const { return mesh_; }
  /// Returns the number of the group of a cut cell; −1 for other cells.
  int group_of(int cell) const { return group_of_[at(cell)]; }
  /// Returns the number of the body that a solid cell belongs to; −1 for other cells. Solid boxes are
  /// not counted.
  int body_of(int cell) const { return body_of_[at(cell)]; }
  int bodies() const { return bodies_; }                             ///< number of bodies
  const std::vector<cut_group>& groups() const { return groups_; }   ///< groups of cut cells
  const std::vector<open_face>& faces() const { return faces_; }     ///< open faces of all groups
  const std::vector<wall_segment>& walls() const { return walls_; }  ///< walls of all groups
  /// Returns the volume of the gas in a cut cell.
  double volume_of(int cell) const;
  /// Returns κ max_k max_± Δx_k Σ_out area / volume of a group.
  double outflow(int group) const { return outflows_[at(group)]; }
  /// Returns the number of cells in which a part of a body is too thin and vanishes.
  int thin_cells() const { return thin_cells_; }

 private:
  friend class mesh_cutter;

  grid mesh_;
  std::vector<int> group_of_, body_of_;
  std::vector<cut_group> groups_;
  std::vector<open_face> faces_;
  std::vector<wall_segment> walls_;
  std::unordered_map<int, double> volumes_;  ///< volume of gas in each cut cell
  std::vector<double> outflows_;             ///< outflow() of each group
  int thin_cells_ = 0, bodies_ = 0;
};

/// Whether a cell of a whole mesh has its own unknown. Solid cells have no unknown; a group has its unknown
/// in its first cell.
bool has_unknown(const grid& mesh, int cell);

}  // namespace apsis
