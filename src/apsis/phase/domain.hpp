#pragma once

#include <apsis/phase/boundary.hpp>
#include <apsis/phase/field.hpp>
#include <apsis/phase/phase_space.hpp>

#include <array>
#include <memory>
#include <vector>

namespace apsis {

/// A phase space with the boundary conditions of its faces. The domain owns the ghost rows, which the
/// boundary of each face fills; a ghost row that repeats an interior row refers to that row without a copy.
class domain {
 public:
  /// Boundaries at the lower and the upper face of a direction.
  using faces = std::array<std::shared_ptr<const boundary>, 2>;

  /// One pair of boundaries for each direction of the mesh. Throws input_error where only one of the two
  /// faces of a direction is periodic.
  domain(phase_space space, std::vector<faces> sides);
  /// Returns a single cell without faces, for equations without space.
  static domain point();

  /// Returns the interior cells and the velocities.
  const phase_space& space() const { return space_; }
  /// Returns the interior cells.
  const grid& mesh() const { return space_.mesh; }
  /// Returns the boundary of a face, as prepared for it.
  const boundary& side(const face& where) const;
  /// Returns the point at which a pencil meets a face.
  position meeting_point(const face& where, int pencil) const;
  /// Whether the direction is periodic.
  bool periodic(int direction) const;
  /// Returns boundary::entropy_bound() of every face that is not periodic; nothing if one of them has none.
  std::optional<std::vector<std::vector<double>>> entropy_bounds() const;

  /// Allocates `width` ghost rows of `components` numbers beyond every face.
  void reserve(int components, int width);
  /// Fills the ghost rows of u at time t.
  void fill_ghosts(double t, const field& u);

  /// rows ← the ghost rows of a pencil beyond a face, counted outwards, of the last fill_ghosts(). The
  /// boundary of the face must fill them.
  void ghost_rows(const face& where, int pencil, std::vector<const double*>& rows) const;

  /// rows[i − begin] ← pointer to the row of cell i of a pencil, i = begin … end−1. Cells outside 0 … n−1 are
  /// ghost cells within the reserved width, with the values of the last fill_ghosts().
  void pencil_rows(const field& u, int direction, int pencil, int begin, int end,
                   std::vector<const double*>& rows) const;

 private:
  domain();

  field& ghosts(const face& where);
  const field& ghosts(const face& where) const;
  bool repeats(const face& where) const;
  const double* ghost_row(const field& u, const face& where, int pencil, int ghost) const;
  void fill_face(const face& where, double t, const field& u);

  phase_space space_;
  std::vector<faces> sides_;
  std::vector<std::array<field, 2>> ghosts_;  ///< [direction][upper], rows [pencil][ghost]
  int width_ = 0;
};

}  // namespace apsis
