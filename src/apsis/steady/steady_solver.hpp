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

/// How a steady state is found.
struct steady_options {
  double tolerance = 1e-8;  ///< of the residual and of the change of the moments
  int iterations = 500;     ///< at most
  int depth = 3;            ///< images that Anderson's mixture remembers
};

/// Returns whether steady states are nonnegative: the model is positive and has no source of its own, its
/// targets are not negative, cells collide by themselves, and the fluxes of `space` are limited or of first
/// order. A source of `space` must not be negative. Where
/// the smallest value is negative, T(f) is then at least that of first-order upwind fluxes, so that T(f) +
/// Q(f)/ε > 0 (docs/steady.md has the proof).
bool is_nonnegative(const relaxation_model& equation, const problem_builder& space);

/// One iteration of steady_solver. Dimensionless.
struct steady_iteration {
  int number = 0;         ///< iterations before
  double residual = 0.0;  ///< ‖T(f) + Q(f)/ε‖₂ relative to that of the start
  /// Largest change δω_i of a moment in the correction of this iteration, relative to its scale
  /// (model::invariant_scales()).
  double change = 0.0;
  int damping = 0;              ///< damping::strength() of its J
  bool rounding = false;        ///< whether the residual is that of rounding
  bool converged = false;       ///< whether f has the tolerance; it is left as it is, but for `removed`
  removed_values removed = {};  ///< by rounding and tolerance, where steady_solver keeps f nonnegative
};

/// Solves T(f) + Q(f)/ε = 0 for the discretization of a problem, without steps in time. Each iteration
/// evaluates the residual R, corrects the moments by the linearised moment equations J δω = ℛT
/// (macroscopic_system), solves (L + σ) δf = R + σ (E(ω + δω) − E(ω)) by an upwind sweep (octant_sweep), and
/// mixes images by Anderson's method. Fixed points are exactly R = 0: J and L decide on the speed alone.
/// Moments that nothing changes, such as the mass between walls, keep their sums.
///
/// With a limiter (problem_builder::keeps_sign()), and a model whose targets are not negative, no steady
/// state is negative. Values that the tolerance leaves below 0 are then set to 0 with the moments of their
/// cells kept; the state after it has the tolerance.
///
/// On several processes every member is collective. J is that of the whole mesh, on the root; the sweep
/// begins at the border of every process with δf = 0. A group of cut cells is swept by the process of its
/// first cell, and δf is copied to the others. The fixed points are the same, the iterates are not.
///
/// Reference: Su, Zhu, Wang, Zhang & Wu (J. Comput. Phys. 407, 2020) for the macroscopic correction of a
/// kinetic sweep. Here J has no terms of Navier–Stokes form: its fluxes are sums over the velocities.
class steady_solver {
 public:
  /// `problem`: built by `space`; its boundary conditions, forces and sources are taken at t = 0. `start`:
  /// the sums of its conserved moments are those of the solution, and its residual is the unit of residuals.
  /// `equation` and `problem` must outlive the solver. Throws input_error without space, in axisymmetric
  /// flow, or if ε is 0 somewhere.
  steady_solver(const relaxation_model& equation, const problem_builder& space, semidiscrete_problem& problem,
                const field& start, const steady_options& options = {});
  ~steady_solver();
  steady_solver(const steady_solver&) = delete;
  steady_solver& operator=(const steady_solver&) = delete;

  /// Moves f nearer to the steady state. Throws numerical_error where f has no equilibrium, or if the
  /// residual has become a million times that of the start, and steady_stall if it has not fallen for a
  /// hundred iterations.
  steady_iteration iterate(field& f);
  /// Forgets all iterations but for reference(), and takes a stronger pseudo-time term than the last one; the
  /// next iteration begins with f of the start again. Returns false, and does nothing, if there is no
  /// stronger term.
  bool begin_again();
  /// Returns ‖T(f) + Q(f)/ε‖₂ relative to reference(), once there is one.
  double relative_residual(const field& f);
  /// Forgets all iterations but for reference(); the next iteration begins with another f, and with a
  /// pseudo-time term of a strength (damping::strength()).
  void restart(int strength);
  /// Returns the time of flight through the shortest extent of the domain at the thermal speed of the first
  /// iteration.
  double flight_time() const;
  /// Returns the number of collisions of that flight, by the mean rate of the first iteration.
  double optical_length() const;

  /// Returns ‖T(f) + Q(f)/ε‖₂ of the first iteration, the unit of residuals; NaN before it.
  double reference() const;
  /// Continues iterations with a unit of residuals that another solver had.
  void set_reference(double residual);

  /// Iterates until convergence, calling `watch` after every iteration. Begins again with f of the start and
  /// a stronger pseudo-time term where iterate() fails, other than by a stall. Where the strongest one does
  /// not help, rarer gases give the next start, once (rarer_gases; their iterations are not watched). Throws
  /// numerical_error where that does not help either, and after the last of options.iterations.
  steady_iteration solve(field& f, const std::function<void(const steady_iteration&)>& watch = {});

 private:
  struct impl;
  std::unique_ptr<impl> impl_;
};

}  // namespace apsis
