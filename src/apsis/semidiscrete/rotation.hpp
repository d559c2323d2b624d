#pragma once

#include <apsis/boundary/domain.hpp>
#include <apsis/exec/aligned.hpp>
#include <apsis/exec/parallel.hpp>
#include <apsis/integrate/problem.hpp>
#include <apsis/mesh/field.hpp>
#include <apsis/model/model.hpp>
#include <apsis/semidiscrete/limited_reconstruction.hpp>

#include <array>
#include <memory>
#include <span>
#include <vector>

namespace apsis {

/// The part (1/r) ∂_ω(v_⊥ sin ω F) of T in axisymmetric flow, for F = r f with the distance r from the axis:
/// a molecule in free flight keeps its velocity, while the radial direction at its place turns. Conservative
/// upwind differences along each ring of velocities (polar_layout), periodic in ω, of the linear fifth-order
/// reconstruction, with limited fluxes where positivity is kept (limited_reconstruction).
///
/// The speed at the edge ω_e = e Δω is −(v_⊥/r) s sin ω_e, s = ½Δω/sin ½Δω, so that the change of a row that
/// does not depend on ω is v_⊥ cos ω_a F/r to rounding. Mass, energy and the momentum along the axis are
/// conserved to rounding. Dimensionless.
class rotation {
 public:
  /// `equation` must outlive the object; `radial`: the direction of r in the mesh. Throws input_error if its
  /// velocities have no rings of a multiple of four angles, or the centre of a cell has r ≤ 0.
  rotation(const model& equation, std::shared_ptr<domain> space, int radial,
           const limited_reconstruction& edges);
  ~rotation();
  rotation(rotation&&) noexcept;  ///< leaves the source empty

  /// acc ← acc + β (1/r) ∂_ω(v_⊥ sin ω u) for every target.
  void add(const field& u, std::span<const target<field, double>> targets) const;
  /// Returns the invariants that the last add() gave per unit of time and β: radial and azimuthal momentum.
  const std::vector<double>& given() const { return given_; }
  /// Returns (v_⊥/r) s |sin ω_e|/Δω of every component, with the smallest r of all cells and the larger of
  /// both edges: the share that leaves per unit of time is at most this number.
  std::span<const double> rates() const { return rates_; }
  /// Sets 1/C of every component for the limiter, C = Δt (Σ_k |v_k|/Δx_k + rates()): the share of a value
  /// that transport through cells may take is C less that of rates().
  void limit_for_steps(std::span<const double> inverse_cfl);

 private:
  struct workspace;
  void find_speeds();
  double smallest_radius() const;
  void add_cell(const field& u, std::span<const target<field, double>> targets, int cell,
                workspace& here) const;

  const model& equation_;
  std::shared_ptr<domain> space_;
  polar_layout layout_;
  int radial_;
  bool limited_, fifth_order_;
  double smallest_radius_;
  aligned_vector<double> speeds_,  ///< s |sin ω| of the edge downstream of every number of a ring
      largest_,                    ///< the larger one of both edges
      rates_, inverse_;            ///< of every component
  std::size_t invariants_;
  mutable std::vector<double> of_cells_;  ///< invariants given to a cell
  mutable std::vector<double> given_;
  std::unique_ptr<per_thread<workspace>> workspaces_;
};

}  // namespace apsis
