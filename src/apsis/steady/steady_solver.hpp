#pragma once

#include <apsis/mesh/field.hpp>
#include <apsis/model/model.hpp>
#include <apsis/semidiscrete/problem_builder.hpp>
#include <apsis/steady/damping.hpp>
#include <apsis/steady/negative_values.hpp>

#include <functional>
#include <memory>
#include <vector>

namespace apsis {

/// Options of steady_solver.
struct steady_options {
  double tolerance = 1e-8;  ///< for the residual and the change of the moments
  int iterations = 500;     ///< largest number of iterations
  int depth = 3;            ///< images in Anderson's mixture
};

/// Returns true if steady states are nonnegative. The model must be positive without a source of its own, and
/// its targets must be nonnegative. Cells must collide separately, and the fluxes of `space` must be limited
/// or of first order. The caller must ensure that a source of `space` is nonnegative. If the smallest value
/// were negative, T(f) would be at least that of first-order upwind fluxes there, so that T(f) + Q(f)/ε > 0
/// (proof in docs/steady.md).
bool is_nonnegative(const relaxation_model& equation, const problem_builder& space);

/// One iteration of steady_solver. Dimensionless.
struct steady_iteration {
  int number = 0;         ///< number of earlier iterations
  double residual = 0.0;  ///< ‖T(f) + Q(f)/ε‖₂ relative to that of the start
  /// Largest change δω_i of a moment in the correction, relative to its scale (model::invariant_scales()).
  double change = 0.0;
  int damping = 0;              ///< damping::strength() of its J
  bool rounding = false;        ///< whether the residual is only rounding
  bool converged = false;       ///< whether f satisfies the tolerance; only `removed` then changes f
  removed_values removed = {};  ///< negative values that were removed, if steady states are nonnegative
};

/// Solves T(f) + Q(f)/ε = 0 for the discretization of a problem, without steps in time. Each iteration
/// has four parts:
/// - it evaluates the residual R,
/// - corrects the moments by the linearised moment equations J δω = ℛT (macroscopic_system),
/// - solves (L + σ) δf = R + σ (E(ω + δω) − E(ω)) by an upwind sweep (octant_sweep),
/// - and mixes images by Anderson's method.
///
/// The fixed points are exactly R = 0: J and L affect only the speed. Moments that only the initial data
/// determine, such as the mass between walls, keep their sums.
///
/// No steady state is negative if a limiter acts (problem_builder::keeps_sign()) and the targets of the model
/// are nonnegative. Values that are negative within the tolerance are then set to 0 without a change of the
/// moments of their cells. The resulting state satisfies the tolerance.
///
/// On several processes every member is collective. J is that of the whole mesh, on the root. The sweep
/// begins at the border of every process with δf = 0. The process with the first cell of a group of cut
/// cells sweeps the group, and copies δf to the others. The fixed points are those of a single process, but
/// the iterates differ.
///
/// Reference: Su, Zhu, Wang, Zhang & Wu (J. Comput. Phys. 407, 2020) for the macroscopic correction of a
/// kinetic sweep. Here J has no terms of Navier–Stokes form: its fluxes are sums over the velocities.
class steady_solver {
 public:
  /// `problem` is built by `space`; its boundary conditions, forces and sources are those at t = 0. `start`
  /// determines the sums of the conserved moments of the solution. Its residual is the unit of residuals.
  /// `equation` and `problem` must outlive the solver. Until the solver is destroyed, the limiter of the
  /// problem is that of steady states (transport::limit_for_steady_states()). Throws input_error without
  /// space, or if ε is 0 in a cell.
  steady_solver(const relaxation_model& equation, const problem_builder& space, semidiscrete_problem& problem,
                const field& start, const steady_options& options = {});
  ~steady_solver();
  steady_solver(const steady_solver&) = delete;
  steady_solver& operator=(const steady_solver&) = delete;

  /// Performs one iteration, which moves f towards the steady state. Throws numerical_error if f has no
  /// equilibrium, or if the residual exceeds that of the start by a factor of 10⁶. Throws steady_stall if the
  /// residual has not fallen for 100 iterations.
  steady_iteration iterate(field& f);
  /// Discards all iterations except reference(), and selects a stronger pseudo-time term. The caller then
  /// begins with f of the start again. Returns false without an effect if there is no stronger term.
  bool begin_again();
  /// Returns ‖T(f) + Q(f)/ε‖₂ relative to reference(), which must be known.
  double relative_residual(const field& f);
  /// Discards all iterations except reference(). The next iteration may begin with another f; its pseudo-time
  /// term has this strength (damping::strength()).
  void restart(int strength);
  /// Returns the time of flight through the shortest extent of the domain at the thermal speed of the
  /// first iteration. Dimensionless.
  double flight_time() const;
  /// Returns the number of collisions during the flight_time(), for the mean rate of the first iteration.
  double optical_length() const;

  /// Returns ‖T(f) + Q(f)/ε‖₂ of the first iteration, the unit of residuals; NaN before the first iteration.
  double reference() const;
  /// Sets the unit of residuals, to continue the iterations of another solver.
  void set_reference(double residual);

  /// Iterates until convergence and calls `watch` after every iteration. If iterate() fails without a stall,
  /// it begins again with f of the start and a stronger pseudo-time term. After a stall, or a failure with
  /// the strongest term, a continuation gives the next start (make_continuation()). Each one is tried once,
  /// without calls of `watch`. Throws numerical_error if no continuation helps, and after options.iterations.
  steady_iteration solve(field& f, const std::function<void(const steady_iteration&)>& watch = {});

 private:
  struct impl;
  std::unique_ptr<impl> impl_;
};

}  // namespace apsis
