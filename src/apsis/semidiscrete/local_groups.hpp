#pragma once

#include <apsis/boundary/domain.hpp>
#include <apsis/mesh/cut_cells.hpp>
#include <apsis/mesh/field.hpp>
#include <apsis/mesh/shared_rows.hpp>

#include <functional>
#include <vector>

namespace apsis {

/// The groups of cut cells that a process works on. Processes that share a group all compute it from equal
/// rows, so they get the same bits without an exchange of rates. Lines are also computed in groups next to
/// cells of this process. Cells are those of the whole mesh; their rows have a place: the number of a cell of
/// this process, or −1 − the number of a received row.
class local_groups {
 public:
  /// `space` has cut cells, and must outlive the object.
  explicit local_groups(const domain& space);

  /// Returns the groups whose lines this process needs, in increasing order.
  const std::vector<int>& fitted() const { return fitted_; }
  /// Returns its cells in a group, as numbers in its block.
  std::vector<int> cells_here(int group) const;
  /// Returns the place of the row of a cell: of its group, if it is cut. Throws std::out_of_range for cells
  /// that are not next to groups of fitted().
  int place_of(int cell) const;
  /// Returns the number in the block of this process of a cell; −1 for those of others.
  int number_here(int cell) const;

  /// Receives the rows of u next to groups of this process. Collective.
  void exchange(const field& u);
  /// Returns the row at a place, of the u of exchange().
  const double* row(const field& u, int place) const {
    return place >= 0 ? u.row(place) : rows_.row(-1 - place);
  }

  /// Receives the values at faces between whole cells of other processes and groups of this one.
  /// values(face) are those of a whole cell of this process. Collective.
  void exchange_at_faces(int length, const std::function<const double*(int face)>& values);
  /// Returns the place of the values at a face of a whole cell of another process.
  int place_of_face(int face) const { return faces_.place_of(face); }
  /// Returns these values.
  const double* values_at_face(int place) const { return faces_.row(place); }

 private:
  int holder(int cell) const;
  std::vector<int> holders(int cell) const;
  int key_of(int cell) const;
  void plan();

  const domain& space_;
  const cut_cells& cut_;
  std::vector<int> fitted_;
  shared_rows rows_,  ///< by the first cell of a group, or a whole cell
      faces_;         ///< by the number of the face
};

}  // namespace apsis
