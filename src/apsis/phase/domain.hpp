#pragma once

#include <apsis/phase/boundary.hpp>
#include <apsis/phase/field.hpp>
#include <apsis/phase/phase_space.hpp>
#include <apsis/phase/segments.hpp>

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

namespace apsis {

/// A part of the border of the gas whose balance is kept: a face of the domain, or all faces of a solid box.
struct opening {
  std::vector<int> surfaces;  ///< numbers of its surfaces
  face where;                 ///< the face of the domain
  int solid = -1;             ///< or the number of the solid box
};

/// A phase space with the boundary conditions of its faces and of its solid boxes. The domain owns the ghost
/// rows beyond the ends of segments, which the boundary of each surface fills; a ghost row that repeats an
/// interior row refers to that row without a copy.
class domain {
 public:
  /// Boundaries at the lower and the upper face of a direction.
  using faces = std::array<std::shared_ptr<const boundary>, 2>;

  /// One pair of boundaries for each direction of the mesh, and one boundary for each of its solid boxes.
  /// Throws input_error where only one of the two faces of a direction is periodic, or a box is.
  domain(phase_space space, std::vector<faces> sides,
         std::vector<std::shared_ptr<const boundary>> solids = {});
  /// Returns a single cell without faces, for equations without space.
  static domain point();

  /// Returns the interior cells and the velocities.
  const phase_space& space() const { return space_; }
  /// Returns the interior cells.
  const grid& mesh() const { return space_.mesh; }
  /// Whether the direction is periodic.
  bool periodic(int direction) const { return periodic_[static_cast<std::size_t>(direction)]; }

  /// Returns the segments of all pencils.
  const segment_table& segments() const { return segments_; }
  /// Returns a segment of a direction.
  const segment& segment_at(int direction, int number) const {
    return segments_.along(direction)[static_cast<std::size_t>(number)];
  }
  /// Returns the surfaces (segment_table::surfaces()).
  const std::vector<surface>& surfaces() const { return segments_.surfaces(); }
  /// Returns the boundary at a surface, as prepared for it; null at a periodic face.
  const boundary* side(int surface) const { return sides_[static_cast<std::size_t>(surface)].get(); }
  /// Returns the point at which a segment meets a surface.
  position meeting_point(int surface, int place) const;
  /// Returns the cell in front of a surface.
  int cell_at(int surface, int place) const;
  /// Returns the faces that are not periodic and the solid boxes, in this order.
  const std::vector<opening>& openings() const { return openings_; }
  /// Returns the number of ends of segments at an opening, those of its surfaces in their order.
  std::size_t ends_at(const opening& one) const;
  /// Returns boundary::entropy_bound() of every opening; nothing if one of them has none.
  std::optional<std::vector<std::vector<double>>> entropy_bounds() const;

  /// Allocates `width` ghost rows of `components` numbers at every end of a segment.
  void reserve(int components, int width);
  /// Fills the ghost rows of u at time t.
  void fill_ghosts(double t, const field& u);

  /// rows ← the ghost rows beyond an end at a surface, counted outwards, of the last fill_ghosts(). The
  /// boundary of the surface must fill them.
  void ghost_rows(int surface, int place, std::vector<const double*>& rows) const;

  /// rows[i − begin] ← pointer to the row of cell i of a segment, i = begin … end−1. Cells outside 0 … n−1
  /// are ghost cells within the reserved width, with the values of the last fill_ghosts().
  void segment_rows(const field& u, int direction, int segment, int begin, int end,
                    std::vector<const double*>& rows) const;

 private:
  domain();

  bool repeats(int surface) const;
  const double* ghost_row(const field& u, int direction, int segment, bool upper, int ghost) const;
  void fill_surface(int surface, double t, const field& u);

  phase_space space_;
  std::array<bool, 3> periodic_{};
  segment_table segments_;
  std::vector<std::shared_ptr<const boundary>> sides_;  ///< [surface]
  std::vector<opening> openings_;
  std::vector<field> ghosts_;  ///< [surface], rows [place][ghost]
  int width_ = 0;
};

}  // namespace apsis
