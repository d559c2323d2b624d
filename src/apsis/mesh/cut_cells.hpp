#pragma once

#include <apsis/core/index.hpp>
#include <apsis/mesh/grid.hpp>
#include <apsis/velocity/position.hpp>

#include <array>
#include <functional>
#include <unordered_map>
#include <vector>

namespace apsis {

/// A continuous function of space that is positive in the gas and not positive in a body.
using outside_function = std::function<double(const position&)>;

/// The open part of a face between two cells with different unknowns, or of a face of the domain. At least
/// one of the cells is cut.
struct open_face {
  int below = -1,                      ///< cell on the lower side; −1 beyond the domain
      above = -1;                      ///< cell on the upper side; −1 beyond the domain
  int direction = 0;                   ///< normal to it
  double area = 0.0;                   ///< of the open part; a length in two dimensions
  position middle = {};                ///< centroid of the open part
  position from_below = {},            ///< vector to it from the centroid of the gas below
      from_above = {};                 ///< vector to it from the centroid of the gas above
  std::vector<position> corners = {};  ///< at a face of the domain: as wall_segment::corners
};

/// A flat piece of wall in a cut cell.
struct wall_segment {
  int cell = -1;                      ///< whose gas it bounds
  int solid = -1;                     ///< number of the solid box or body: boxes first
  double area = 0.0;                  ///< of the piece; a length in two dimensions
  std::array<double, 3> normal = {};  ///< unit vector into the gas
  position middle = {};               ///< point on the wall
  /// ∫ (x − middle) × n dA / area, n into the gas: the moment of a uniform pressure about `middle`. With it
  /// the moments of a uniform pressure on all pieces of a body add up to 0 to rounding.
  std::array<double, 3> moment = {};
  position from_centre = {};  ///< vector to it from the centroid of the gas
  /// Corners of the piece: in two dimensions its ends, the solid on the left from the first to the second; in
  /// three those of a polygon, counter-clockwise seen from the gas. Their vector area is area × normal to
  /// rounding. Pieces of a body share corners bit by bit.
  std::vector<position> corners = {};
};

/// Cut cells with one unknown in common: a cell, or a small one with its neighbours.
struct cut_group {
  std::vector<int> cells;  ///< in increasing order
  double volume = 0.0;     ///< of the gas in them; an area in two dimensions
  position centre = {};    ///< centroid of the gas, next to the first cell across periodic faces
  std::vector<int> faces,  ///< numbers of its open faces
      walls;               ///< numbers of its wall segments
};

/// The cells of a mesh that bodies cut: volumes of gas, open parts of faces and pieces of wall. The sum of
/// area × normal over the walls and faces of a group is 0 to rounding, so that a uniform gas stays uniform.
/// A face has one area for both of its cells. All other cells of the gas are whole: none of their faces is
/// open in part.
///
/// Small cells join the neighbours behind their largest open faces until
///     κ max_k max_± Δx_k Σ_out area / volume ≤ 1
/// holds for every group, with the sum over faces and walls through which a motion along ±x_k leaves. A step
/// of Δt ≤ κ / max Σ_k |v_k|/Δx_k then empties no cell: the outflow of a velocity is a convex function of it,
/// and has its maximum for Σ_k |v_k|/Δx_k = 1 on an axis.
///
/// Dimensionless lengths.
class cut_cells {
 public:
  /// κ. Larger ones join more cells: for κ = 1, those along a wall would have to join without end.
  static constexpr double cfl_number = 0.5;

  /// `mesh` has two or three dimensions and may have solid boxes; `bodies`: φ of each; `periodic`: of each
  /// direction. Throws input_error if
  /// - φ is not finite at a corner of a cell;
  /// - a body crosses a periodic face, and differs at the opposite one;
  /// - a gap between bodies is thinner than a cell, or most of a body, with the number of cells that are
  ///   needed;
  /// - a body lies between the corners of the cells;
  /// - no cell of gas is left.
  cut_cells(const grid& mesh, const std::vector<outside_function>& bodies,
            const std::array<bool, 3>& periodic);

  /// Returns the number of the group of a cut cell; −1 for other cells.
  int group_of(int cell) const { return group_of_[at(cell)]; }
  /// Returns the number of the body that a solid cell belongs to, counted without solid boxes; −1 for other
  /// cells.
  int body_of(int cell) const { return body_of_[at(cell)]; }
  int bodies() const { return bodies_; }                             ///< number of bodies
  const std::vector<cut_group>& groups() const { return groups_; }   ///< cut cells
  const std::vector<open_face>& faces() const { return faces_; }     ///< of all groups
  const std::vector<wall_segment>& walls() const { return walls_; }  ///< of all groups
  /// Returns the volume of the gas in a cut cell.
  double volume_of(int cell) const;
  /// Returns κ max_k max_± Δx_k Σ_out area / volume of a group.
  double outflow(int group) const { return outflows_[at(group)]; }
  /// Returns the number of cells in which a part of a body is too thin, and vanishes.
  int thin_cells() const { return thin_cells_; }

 private:
  friend class mesh_cutter;

  std::vector<int> group_of_, body_of_;
  std::vector<cut_group> groups_;
  std::vector<open_face> faces_;
  std::vector<wall_segment> walls_;
  std::unordered_map<int, double> volumes_;  ///< of each cut cell
  std::vector<double> outflows_;             ///< of each group
  int thin_cells_ = 0, bodies_ = 0;
};

/// Whether a cell of a whole mesh has an unknown of its own: not if it is solid, or if another cell of its
/// group comes first.
bool has_unknown(const grid& mesh, int cell);

}  // namespace apsis
