#pragma once

#include <apsis/boundary/domain.hpp>
#include <apsis/exec/aligned.hpp>
#include <apsis/exec/parallel.hpp>
#include <apsis/integrate/problem.hpp>
#include <apsis/mesh/field.hpp>
#include <apsis/model/model.hpp>
#include <apsis/semidiscrete/block_sweep.hpp>
#include <apsis/semidiscrete/global_integrals.hpp>
#include <apsis/semidiscrete/limited_reconstruction.hpp>
#include <apsis/semidiscrete/ring_turn.hpp>

#include <array>
#include <memory>
#include <span>
#include <vector>

namespace apsis {

/// The part (1/r) ∂_ω(v_⊥ sin ω F) of T in axisymmetric flow, for F = r f with the distance r from the axis.
/// A molecule in free flight keeps its velocity, but the radial direction at its place turns. The part uses
/// conservative upwind differences along each ring of velocities (polar_layout), periodic in ω. Fluxes are
/// limited if positivity is required (limited_reconstruction).
///
/// The flux at the edge ω_e = e Δω is −v_⊥ ĝ/r. With the point values F_a and s = ½Δω/sin ½Δω,
///     ĝ = s sin ω F̂ − Δω cos ω ((1/12 + 7Δω²/1440) Δω ∂F − Δω³ ∂³F/120) − sin ω Δω² (Δω² ∂²F)/180.
/// F̂ is the linear reconstruction of fifth order. It alone would give second order, since ĝ reconstructs sin
/// ω F. Derivatives are differences of the four values around the edge. To rounding, the change of a row that
/// does not depend on ω is then v_⊥ cos ω_a F/r. At first order ĝ = s sin ω F_a. Mass, energy and the
/// momentum along the axis are conserved to rounding. Dimensionless.
class ring_rotation {
 public:
  /// `equation` must outlive the object, and `radial` is the direction of r in the mesh. Rings have a
  /// multiple of four angles, at least 12 beyond first order. Throws input_error if the velocities have no
  /// such rings, or if the centre of a cell has r ≤ 0.
  ring_rotation(const model& equation, std::shared_ptr<domain> space, int radial,
                const limited_reconstruction& edges);
  ~ring_rotation();
  ring_rotation(ring_rotation&&) noexcept;  ///< leaves the moved-from object empty

  /// Prepares the memory of all threads for add().
  void prepare(const field& u) const;
  /// acc ← acc + β (1/r) ∂_ω(v_⊥ sin ω u) in the cells begin … end−1 for every target, by any thread.
  void add(const field& u, std::span<const target<field, double>> targets, int begin, int end) const;
  /// Computes given() once add() was called for all cells that are not solid. Collective.
  void integrate() const { given_ = global_integrals(*space_, of_cells_, invariants_); }
  /// Returns the amounts of the invariants that were given per unit of time and β: radial and azimuthal
  /// momentum.
  const std::vector<double>& given() const { return given_; }
  /// Returns the rate of each component that limits the step, repeated for as many cells as the speeds,
  ///     q |v_r|/Δr + |v_x|/Δx + (v_⊥/r) s |sin ω_e|/Δω
  /// with the smallest r of all cells and the edge of outflow. Without limiter q = 1. With a limiter q = 1 +
  /// Δr/(2r) for v_r > 0: in uniform gas F = r f is larger by this factor at the outer edge of a cell, and
  /// its outflow must not be limited. At the axis q = 2. The largest rate is that of a velocity with v_r < 0.
  aligned_vector<double> rates_with(const std::vector<line_speeds>& speeds) const;
  /// Divides the values among transport and rotation for forward Euler steps of a length, such that both keep
  /// their parts nonnegative. Also sets C of transport. Let x = Δt rates_with() ≤ 1 for a step Δt, and R the
  /// part of rotation in x. Rotation gets the part R/√x of the values, and transport the rest, with
  ///     C = (x − R)/(1 − R/√x) ≤ 1,  divided by q along r.
  /// Both limiters are then weak for short steps. The limiter of transport is weak everywhere for
  /// components that hardly rotate, because one C serves all cells. R is that of the faster edge if the
  /// largest rate permits this.
  void limit_for_steps(double step, std::vector<line_speeds>& speeds);
  /// Limits steady states instead, as limiter::steady_inverse_cfl() does, with the slowest rate of
  /// collisions. Outflow of uniform gas along r is not limited.
  void limit_for_steady_states(double collisions, std::vector<line_speeds>& speeds);
  /// Returns the part of the values of each component that is left to transport.
  const aligned_vector<double>& left() const { return left_; }

 private:
  struct workspace;
  void find_rates();
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
  ring_turn turn_;
  int radial_;
  bool limited_;
  bool steady_ = false;               ///< whether limits are those of steady states, equal at every r
  double smallest_radius_, at_edge_;  ///< smallest r, and q there
  aligned_vector<double> per_speed_,  ///< r Δω/v_⊥ of every component with the smallest r
      rates_,                         ///< outflow rate of every component by rotation at the smallest r
      largest_,                       ///< the same with the larger speed of both edges
      inverse_, left_;                ///< 1/τ of the limiter there, and the part left to transport
  std::size_t invariants_;
  mutable std::vector<double> of_cells_;  ///< invariants given to a cell
  mutable std::vector<double> given_;
  std::unique_ptr<per_thread<workspace>> workspaces_;
};

}  // namespace apsis
