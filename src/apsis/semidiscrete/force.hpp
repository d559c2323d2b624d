#pragma once

#include <apsis/boundary/domain.hpp>
#include <apsis/exec/parallel.hpp>
#include <apsis/integrate/problem.hpp>
#include <apsis/mesh/field.hpp>
#include <apsis/model/acceleration.hpp>
#include <apsis/model/model.hpp>
#include <apsis/semidiscrete/lattice_rows.hpp>
#include <apsis/semidiscrete/limited_reconstruction.hpp>

#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <span>
#include <vector>

namespace apsis {

/// The part −a(t, x)·∇_v f of T on a velocity lattice. It uses conservative differences of the linear
/// fifth-order upwind reconstruction along v. There is no flux through the ends of the lattice, and fluxes
/// are limited if positivity is required (limited_reconstruction). To rounding, the sums of the
/// reconstruction give the momentum ρa and the energy ρu·a per unit of time. Exceptions are limited fluxes
/// and molecules at the ends of the lattice; losses() measures the difference. Dimensionless.
class force {
 public:
  /// `equation` must outlive the object. Throws input_error if its velocities are no lattice of at least five
  /// points, or if `of` has no finite bound.
  force(const model& equation, std::shared_ptr<domain> space, acceleration of,
        const limited_reconstruction& edges);
  ~force();
  force(force&&) noexcept;  ///< leaves the moved-from object empty

  /// Prepares the memory of all threads for add().
  void prepare(const field& u) const;
  /// acc ← acc + β (−a·∇_v u) in the cells begin … end−1 for every target, by any thread. Throws
  /// numerical_error if a is not finite or exceeds its bound.
  void add(double t, const field& u, std::span<const target<field, double>> targets, int begin,
           int end) const;
  /// Computes given() and losses() once add() was called for all cells that are not solid. Collective.
  void integrate() const;
  /// Returns the amounts of the invariants that were given per unit of time and β.
  const std::vector<double>& given() const { return given_; }
  /// Returns the losses at the ends of the lattice and by limited fluxes, per unit of time and β, in the
  /// layout of force_losses.
  const std::vector<double>& losses() const { return losses_; }
  /// Returns the rate 1/Δt_FE of the force alone: Σ_k |a_k|/Δv with the bounds, and 12 times this rate for
  /// limited fluxes. Between neighbouring velocities f may differ by powers of ten, so that limited fluxes
  /// for steps up to Δv/|a| would cost accuracy. The short steps cost little, because a force is weak
  /// compared with the motion through cells.
  double rate() const;
  /// Sets the bound of the limiter: β rate() ≤ share α in all later calls, 0 < share ≤ 1 (initially 1).
  void limit_for_steps(double share) { share_ = share; }

  /// Returns a in a cell. Throws numerical_error if a is not finite or exceeds its bound.
  std::array<double, 3> acceleration_in(double t, int cell) const;
  /// Returns the layout of rows along a direction of the lattice.
  lattice_rows::layout layout_along(std::size_t direction) const;
  /// Returns the rule for fluxes along a direction with the acceleration a.
  lattice_rows::flux_rule rule_for(double a) const;
  /// Returns |a|/Δv along a direction.
  double rate_along(std::size_t direction, double a) const {
    return std::abs(a) / lattice_.spacing[direction];
  }
  /// Returns the number of sums of a cell: the invariants that the force gave, the invariants of its row, and
  /// the mass that entered the last points (force_losses).
  std::size_t sums_of_cell() const { return invariants_ + losses_.size(); }
  /// Computes given() and losses() from the sums of every cell; at(cell) returns
  /// its acceleration. Collective.
  void balance(std::span<const double> sums, const std::function<std::array<double, 3>(int)>& at) const;

 private:
  struct workspace;
  void set_losses(const std::array<double, 3>& a, double* sums) const;
  void add_cell(double t, const field& u, std::span<const target<field, double>> targets, int cell,
                workspace& here) const;
  double add_direction(const double* row, std::size_t direction, double a, bool fresh, workspace& here) const;
  double mass_into_ends(const lattice_rows::layout& at, bool forward, const double* into_last) const;

  const model& equation_;
  std::shared_ptr<domain> space_;
  velocity_lattice lattice_;
  acceleration acceleration_;
  bool limited_;
  double share_ = 1.0;  ///< bound for the limiter
  bool fifth_order_;
  std::size_t invariants_;
  mutable std::vector<double> of_cells_;  ///< invariants given to a cell, and its losses
  mutable std::vector<double> given_, losses_;
  std::unique_ptr<per_thread<workspace>> workspaces_;
};

}  // namespace apsis
