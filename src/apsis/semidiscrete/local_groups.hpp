#pragma once

#include <apsis/boundary/domain.hpp>
#include <apsis/mesh/cut_cells.hpp>
#include <apsis/mesh/field.hpp>
#include <apsis/mesh/shared_rows.hpp>

#include <functional>
#include <vector>

namespace apsis {

/// The groups of cut cells that a process computes. Processes that share a group compute it from equal rows
/// and get the same bits, so that they need not exchange rates. A process also computes the lines of groups
/// next to its cells. Cell numbers are those of the whole mesh. The row of a cell has a place: the number of
/// a cell of this process, or −1 − the number of a received row.
class local_groups {
 public:
  /// `space` must have cut cells and outlive the object.
  explicit local_groups(const domain& space);

  /// Returns the groups with lines that this process needs, in increasing order.
  const std::vector<int>& fitted() const { return fitted_; }
  /// Returns the cells of this process in a group, as numbers in its block.
  std::vector<int> cells_here(int group) const;
  /// Returns the place of the row of a cell, or of the row of its group if the cell is cut. Throws
  /// std::out_of_range for cells that are not next to groups of fitted().
  int place_of(int cell) const;
  /// Returns the number of a cell in the block of this process; −1 for cells of others.
  int number_here(int cell) const;
  /// Returns the cells of this process with rows that exchange() sends, as numbers in its block.
  const std::vector<int>& sent_cells() const { return sent_; }

  /// Receives the rows of u that are next to groups of this process. Collective.
  void exchange(const field& u);
  /// Returns the row at a place, for the u of exchange().
  const double* row(const field& u, int place) const {
    return place >= 0 ? u.row(place) : rows_.row(-1 - place);
  }

  /// Receives the values at faces between whole cells of other processes and groups of this process.
  /// values(face) are those of a whole cell of this process. Collective.
  void exchange_at_faces(int length, const std::function<const double*(int face)>& values);
  /// Returns the place of the values at a face of a whole cell of another process.
  int place_of_face(int face) const { return faces_.place_of(face); }
  /// Returns the values at such a place.
  const double* values_at_face(int place) const { return faces_.row(place); }

 private:
  int holder(int cell) const;
  std::vector<int> holders(int cell) const;
  int key_of(int cell) const;
  void plan();

  const domain& space_;
  const cut_cells& cut_;
  std::vector<int> fitted_, sent_;
  shared_rows rows_,  ///< by whole cell, or the first cell of a group
      faces_;         ///< by number of the face
};

}  // namespace apsis
