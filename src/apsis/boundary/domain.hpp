#pragma once

#include <apsis/boundary/boundary.hpp>
#include <apsis/core/construction_count.hpp>
#include <apsis/mesh/distribution.hpp>
#include <apsis/mesh/field.hpp>
#include <apsis/mesh/halo_exchange.hpp>
#include <apsis/mesh/phase_space.hpp>
#include <apsis/mesh/segments.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace apsis {

/// A part of the border of the gas with a budget of its own: a face of the domain, or the whole surface of a
/// solid box or body.
struct budget_surface {
  std::vector<int> surfaces;        ///< numbers of its surfaces
  face where;                       ///< the face of the domain
  int solid = -1;                   ///< the number of the solid box or body; −1 for a face
  std::vector<int> cut_faces = {},  ///< open faces of cut cells of this process, at a face of the domain
      walls = {};  ///< wall segments in these cells of a solid box or body, as numbers in cut_cells
};

/// A phase space with the boundary conditions of its faces, of its solid boxes and bodies. The domain owns
/// the ghost rows beyond the ends of segments. The boundary of each surface fills these rows. A ghost row
/// that repeats an interior row refers to that row without a copy.
class domain : public construction_count<domain> {
 public:
  /// Boundaries at the lower and the upper face of a direction.
  using faces = std::array<std::shared_ptr<const boundary>, 2>;

  /// Takes one pair of boundaries for each direction of the mesh, and one boundary for each of its solid
  /// boxes and bodies. Throws input_error if a number of boundaries is wrong, if only one of the two faces of
  /// a direction is periodic, or if a solid is.
  domain(phase_space space, const std::vector<faces>& sides,
         const std::vector<std::shared_ptr<const boundary>>& solids = {});
  /// Constructs the block of this process of a mesh that several processes share; `space` has this block
  /// as its mesh.
  domain(phase_space space, const std::vector<faces>& sides,
         const std::vector<std::shared_ptr<const boundary>>& solids, const distribution& shared);
  /// Returns a single cell without faces, for equations without space.
  static domain point();

  /// Returns the interior cells and the velocities.
  const phase_space& space() const { return space_; }
  /// Returns the interior cells.
  const grid& mesh() const { return space_.mesh; }
  /// Returns true if the direction is periodic.
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
  /// Returns true if a surface is the border to cut cells.
  bool is_border_of_cut_cells(int surface) const {
    return mesh().cut() != nullptr &&
           surfaces()[static_cast<std::size_t>(surface)].solid == mesh().obstacles();
  }
  /// Returns the boundary of a solid box or body, as given.
  const std::shared_ptr<const boundary>& solid_boundary(int solid) const {
    return solids_[static_cast<std::size_t>(solid)];
  }
  /// Returns the boundary at a budget surface: as prepared for a face, as given for a solid box or body.
  const boundary& boundary_at(const budget_surface& one) const {
    return one.solid < 0 ? *side(one.surfaces.front()) : *solid_boundary(one.solid);
  }
  /// Returns the point at which a segment meets a surface.
  position meeting_point(int surface, int place) const;
  /// Returns the cell in front of a surface. The cell is local if segment::ends_here(), otherwise it may
  /// belong to another process.
  int cell_at(int surface, int place) const;
  /// Returns the faces that are not periodic, the solid boxes and the bodies, in this order.
  const std::vector<budget_surface>& budget_surfaces() const { return budget_surfaces_; }
  /// Returns the number of ends at a budget surface: the ends of segments at its surfaces in their order,
  /// then its cut faces and its walls.
  std::size_t ends_at(const budget_surface& one) const;
  /// Returns boundary::entropy_bound() of every budget surface; nothing if one of them has no bound.
  std::optional<std::vector<std::vector<double>>> entropy_bounds() const;

  /// Returns the processes that share the mesh.
  communicator& processes() const { return *processes_; }
  /// Returns the number in the whole mesh of a cell of this process; −1 for −1.
  long number_in_whole_mesh(long cell) const;
  /// Returns the number in the block of this process of a cell of the whole mesh; −1 for cells of others.
  int number_in_block(int cell) const;
  /// Returns true if other processes have cells of the mesh.
  bool shared() const { return distribution_.has_value(); }
  /// Returns the mesh that several processes share; null for a single process.
  const distribution* shared_mesh() const { return distribution_ ? &*distribution_ : nullptr; }
  /// Returns true if other processes continue the pencils along a direction.
  bool splits(int direction) const { return halo_ && halo_->splits(direction); }

  /// Allocates `width` ghost rows of `components` numbers at every end of a segment. All processes must call
  /// this before the places of ends are used.
  void reserve(int components, int width);
  /// Fills the ghost rows of u at time t, and receives the rows of other processes.
  void fill_ghosts(double t, const field& u);
  /// Begins fill_ghosts(). Rows that depend on no other process (is_inner()) may be
  /// read before finish_ghosts().
  void begin_ghosts(double t, const field& u);
  /// Advances the messages with rows of other processes between begin_ghosts() and finish_ghosts(). Only the
  /// thread that communicates may call this.
  void advance_ghosts() const {
    if (halo_) halo_->advance();
  }
  /// Completes begin_ghosts().
  void finish_ghosts(double t, const field& u);
  /// Returns true if the cells of a box and their neighbours within the ghost width depend on
  /// no other process.
  bool is_inner(const cell_box& box) const;
  /// Receives the rows of other processes, without filling ghost rows.
  void exchange(const field& u);

  /// Returns the row of the cell across an end of a segment, after exchange(). This cell belongs to another
  /// process or is a periodic neighbour. Returns nullptr if the gas ends there.
  const double* row_across(const field& u, int direction, int segment, bool upper) const;

  /// Returns the ghost rows beyond an end at a surface as of the last fill_ghosts(), counted outwards. The
  /// boundary of the surface must fill them, so that repeats() is false.
  std::span<const double* const> ghost_rows(int surface, int place) const;
  /// Returns true if the ghost rows beyond a surface are rows inside, without memory of their own.
  bool repeats(int surface) const;
  /// Returns true if the boundary prescribes the components that enter at the end `place` of a surface.
  bool prescribes_incoming(int surface, int place) const;
  /// Returns the row of the cell at the end `place` of a surface, as of the last fill_ghosts().
  const double* row_at(int surface, int place) const;

  /// rows[i − begin] ← pointer to the row of cell i of a segment, i = begin … end−1. Cells outside 0 … n−1
  /// are ghost cells within the reserved width, with the values of the last fill_ghosts().
  void segment_rows(const field& u, int direction, int segment, int begin, int end,
                    const double** rows) const;
  /// Does the same with a vector, which it resizes to end − begin.
  void segment_rows(const field& u, int direction, int segment, int begin, int end,
                    std::vector<const double*>& rows) const {
    rows.resize(static_cast<std::size_t>(end - begin));
    segment_rows(u, direction, segment, begin, end, rows.data());
  }

 private:
  domain();

  /// Selects ends of segments by the cells on which their ghost rows depend.
  enum class end_kind { all, of_own_cells, of_others };

  void set_sides(const std::vector<faces>& sides, const std::vector<std::shared_ptr<const boundary>>& solids);
  void add_cut_ends();
  double open_area(const budget_surface& one) const;
  /// Returns the number of rows inside that a boundary may read.
  int rows_inside() const { return std::max(width_, 3); }
  int pencil_of(int direction, const segment& one) const;
  int visible(int direction, const segment& one, bool upper) const;
  const double* inside_row(const field& u, int direction, const segment& one, bool upper, int cell) const;
  const double* ghost_row(const field& u, int direction, int segment, bool upper, int ghost) const;
  bool needs_others(int direction, const segment& one, bool upper) const;
  void fill_surfaces(double t, const field& u, end_kind which);
  void fill_surface(int surface, double t, const field& u, end_kind which);

  /// The rows on both sides of the ends at a surface. The pointers are stored, so that filling
  /// does not allocate.
  struct end_rows {
    field ghosts;                       ///< [place][ghost]
    std::vector<double*> beyond;        ///< [place][ghost], rows of `ghosts`
    std::vector<const double*> inside;  ///< [place][cell], rows of the state of the last fill_ghosts()
  };

  phase_space space_;
  std::shared_ptr<communicator> processes_ = single_process();
  std::optional<distribution> distribution_;  ///< of a mesh that several processes share
  std::unique_ptr<halo_exchange> halo_;
  std::array<bool, 3> periodic_{};
  segment_table segments_;
  std::vector<std::shared_ptr<const boundary>> sides_,  ///< [surface]
      solids_;                                          ///< of boxes and bodies
  std::vector<budget_surface> budget_surfaces_;
  std::vector<end_rows> end_rows_;  ///< [surface]
  int width_ = 0;
};

}  // namespace apsis
