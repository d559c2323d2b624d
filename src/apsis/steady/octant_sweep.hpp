#pragma once

#include <apsis/boundary/domain.hpp>
#include <apsis/model/model.hpp>
#include <apsis/semidiscrete/ring_turn.hpp>
#include <apsis/steady/cell_links.hpp>
#include <apsis/steady/cut_links.hpp>
#include <apsis/steady/sweep_rows.hpp>

#include <array>
#include <memory>
#include <span>
#include <vector>

namespace apsis {

/// An implicit step of upwind transport and relaxation, (L + σ) δ = r with L δ = Σ_k v_k ∂_k δ. One pass
/// in the direction of flight of every component solves it exactly. The value at the downstream edge of
/// cell i is δ_i + s (δ_i − δ_{i−1}), or δ_i next to the beginning of the gas. Components whose velocities
/// have equal signs form an octant. Octants follow one another. At an end of the gas the boundary
/// condition determines the components that enter in later octants from those that leave. Nothing enters
/// across periodic faces.
///
/// In axisymmetric flow L also has the rotation of rings (ring_turn), of first order. A ring turns from ω = π
/// to ω = 0, so that velocities towards the axis come before those away from it. At the axis δ continues as
/// −δ of the opposite velocity.
///
/// In cut cells L is of first order: (Σ_out w + σ) δ_i = r_i + Σ_in w δ_up. The weights w = |v·n| area/volume
/// belong to the open faces and walls of a group. If groups and cells depend on each other in a circle,
/// values that are computed later are omitted.
class octant_sweep {
 public:
  /// All references must outlive the object. `slope` is s, from 0 for first order to ½ for second order. With
  /// a rotation r is the last direction of the mesh.
  octant_sweep(const relaxation_model& equation, const domain& space, const cell_links& links,
               const cut_links& cut, double slope, const ring_turn* turn = nullptr);
  ~octant_sweep();
  octant_sweep(const octant_sweep&) = delete;
  octant_sweep& operator=(const octant_sweep&) = delete;

  /// r ← δ. `f` is the state in front of the ends: a boundary condition gives the difference of its values
  /// for f with and without changes. `rates` are σ of every cell.
  void solve(const field& f, const std::vector<double>& rates, field& r);

 private:
  struct octant {
    std::array<bool, 3> up{};  ///< whether the velocity is positive along each direction
    std::vector<sweep_rows::strip> strips;
    std::vector<int> order;  ///< cells in the order of the sweep
    std::vector<int> place;  ///< place of a cell in this order; empty without cut cells

    std::vector<sweep_rows::strip> part(int number, int parts) const;
    /// Returns the strips of a part of the rings.
    std::vector<sweep_rows::strip> rings(int first, int end, std::size_t size_of_ring) const;
  };
  struct scratch;

  void add_strips(const std::vector<std::array<bool, 3>>& signs, const ring_turn* turn);
  void set_order(octant& of) const;
  std::vector<sweep_rows::strip> part(const octant& of, int number, int parts) const;
  sweep_rows::rotation rotation_in(int cell) const;
  int axis_next_to(int direction, bool upper, int cell) const;
  void wait_for_cut_cells(octant& of) const;
  std::vector<int> upstream_of(const octant& of, int cell) const;
  void respond(const octant& of, const field& f, const field& delta);
  void pass(const octant& of, std::span<const sweep_rows::strip> strips, const std::vector<double>& rates,
            field& r) const;
  void pass_cut(const octant& of, int group, std::span<const sweep_rows::strip> strips, double rate,
                field& r) const;
  void respond_at_walls(const octant& of, const field& f, const field& delta);
  template <class Arrives>
  bool add_changes_before(const octant& one, const Arrives& arrives, const double* changes,
                          double* row) const;
  sweep_rows::upstream terms_of(const octant& of, int cell, int direction, const field& r) const;

  const relaxation_model& equation_;
  const domain& space_;
  const cell_links& links_;
  const cut_links& cut_;
  double slope_;
  std::vector<octant> octants_;
  std::array<aligned_vector<double>, 3> per_cell_;  ///< |v_k|/Δx_k of every component
  std::size_t size_of_ring_ = 0;                    ///< components of a ring; 0 without rotation
  aligned_vector<double> turns_out_, turns_in_;     ///< rates of rotation at the radius 1
  field entering_,                                  ///< [end], δ of the components that enter
      entering_cut_;                                ///< the same at the ends of cut cells
  struct cut_end {
    int group, way;
  };
  std::vector<cut_end> cut_ends_;             ///< ends of cut cells
  std::vector<std::vector<int>> end_of_way_;  ///< [group][way], index in cut_ends_; −1 for others
  std::unique_ptr<scratch> scratch_;
};

}  // namespace apsis
