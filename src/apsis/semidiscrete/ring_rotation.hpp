#pragma once

#include <apsis/boundary/domain.hpp>
#include <apsis/exec/aligned.hpp>
#include <apsis/exec/parallel.hpp>
#include <apsis/integrate/problem.hpp>
#include <apsis/mesh/field.hpp>
#include <apsis/model/model.hpp>
#include <apsis/semidiscrete/block_sweep.hpp>
#include <apsis/semidiscrete/limited_reconstruction.hpp>

#include <array>
#include <memory>
#include <span>
#include <vector>

namespace apsis {

/// The part (1/r) ∂_ω(v_⊥ sin ω F) of T in axisymmetric flow, for F = r f with the distance r from the axis:
/// a molecule in free flight keeps its velocity, while the radial direction at its place turns. Conservative
/// upwind differences along each ring of velocities (polar_layout), periodic in ω, with limited fluxes where
/// positivity is kept (limited_reconstruction).
///
/// The flux at the edge ω_e = e Δω is −v_⊥ ĝ/r of the point values F_a with
///     ĝ = s sin ω F̂ − Δω cos ω ((1/12 + 7Δω²/1440) Δω ∂F − Δω³ ∂³F/120) − sin ω Δω² (Δω² ∂²F)/180,
/// s = ½Δω/sin ½Δω. F̂ is the linear reconstruction of fifth order. It alone would give second order, since ĝ
/// reconstructs sin ω F. Derivatives are differences of the four values around the edge. The change of a row
/// that does not depend on ω is thus v_⊥ cos ω_a F/r to rounding. At first order ĝ = s sin ω F_a. Mass,
/// energy and the momentum along the axis are conserved to rounding. Dimensionless.
class ring_rotation {
 public:
  /// `equation` must outlive the object; `radial`: the direction of r in the mesh. Throws input_error if its
  /// velocities have no rings or the centre of a cell has r ≤ 0. Rings have a multiple of four angles, beyond
  /// first order at least 12.
  ring_rotation(const model& equation, std::shared_ptr<domain> space, int radial,
                const limited_reconstruction& edges);
  ~ring_rotation();
  ring_rotation(ring_rotation&&) noexcept;  ///< leaves the source empty

  /// acc ← acc + β (1/r) ∂_ω(v_⊥ sin ω u) for every target.
  void add(const field& u, std::span<const target<field, double>> targets) const;
  /// Returns the invariants that the last add() gave per unit of time and β: radial and azimuthal momentum.
  const std::vector<double>& given() const { return given_; }
  /// Returns the rate of each component that limits the step, for as many cells as the speeds,
  ///     q |v_r|/Δr + |v_x|/Δx + (v_⊥/r) s |sin ω_e|/Δω
  /// with the smallest r of all cells and the edge of outflow. q = 1 without limiter. With one, q = 1 +
  /// Δr/(2r) for v_r > 0. In uniform gas F = r f is larger by this factor at the outer edge of a cell, and
  /// its outflow must not be limited. At the axis q = 2. The largest rate is that of a velocity with v_r < 0.
  aligned_vector<double> rates_with(const std::vector<line_speeds>& speeds) const;
  /// Divides the values among transport and rotation for forward Euler steps of a length, such that both keep
  /// their parts nonnegative; sets C of transport. Let x = Δt rates_with() ≤ 1 for a step Δt, and R the part
  /// of rotation in it. Rotation gets the share R/√x, transport the rest with
  ///     C = (x − R)/(1 − R/√x) ≤ 1,  divided by q along r.
  /// Both limiters are then weak for short steps, and that of transport everywhere for components that hardly
  /// rotate: one C serves all cells. R is that of the faster edge where the largest rate leaves it room.
  void limit_for_steps(double step, std::vector<line_speeds>& speeds);
  /// Returns the share of the values of each component that is left to transport.
  const aligned_vector<double>& left() const { return left_; }

 private:
  struct workspace;
  void find_speeds();
  std::size_t size_of_ring() const {
    return static_cast<std::size_t>(layout_.angles) * static_cast<std::size_t>(layout_.apart);
  }
  /// Rings of a second set of components repeat those of the first.
  double speed_of(std::size_t ring) const { return layout_.speeds[ring % layout_.speeds.size()]; }
  std::size_t stride() const { return static_cast<std::size_t>(field(1, equation_.components()).stride()); }
  /// Returns q of component k along a direction.
  double factor_of(const line_speeds& line, std::size_t direction, std::size_t k) const {
    return direction == static_cast<std::size_t>(radial_) && line.forward[k] != 0.0 ? at_edge_ : 1.0;
  }
  aligned_vector<double> rates_through_cells(const std::vector<line_speeds>& speeds) const;
  double smallest_radius() const;
  void add_cell(const field& u, std::span<const target<field, double>> targets, int cell,
                workspace& here) const;

  const model& equation_;
  std::shared_ptr<domain> space_;
  polar_layout layout_;
  int radial_;
  bool limited_, fifth_order_;
  double smallest_radius_, at_edge_;  ///< and q
  double stretch_ = 1.0;              ///< s
  aligned_vector<double> speeds_,     ///< s |sin ω| of the edges of a ring, `apart` numbers each
      slopes_,                        ///< Δω cos ω of the edges
      per_speed_,                     ///< r Δω/v_⊥ of every component with the smallest r
      rates_,                         ///< of outflow of every component by rotation there
      largest_,                       ///< with the larger speed of both edges
      inverse_, left_;                ///< 1/τ of the limiter there, and the share left to transport
  std::size_t invariants_;
  mutable std::vector<double> of_cells_;  ///< invariants given to a cell
  mutable std::vector<double> given_;
  std::unique_ptr<per_thread<workspace>> workspaces_;
};

}  // namespace apsis
