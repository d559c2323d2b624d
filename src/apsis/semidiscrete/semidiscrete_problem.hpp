#pragma once

#include <apsis/core/first_error.hpp>
#include <apsis/exec/agreement.hpp>
#include <apsis/exec/global_sum.hpp>
#include <apsis/exec/parallel.hpp>
#include <apsis/integrate/verbs.hpp>
#include <apsis/semidiscrete/collision.hpp>
#include <apsis/semidiscrete/transport.hpp>

#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace apsis {

/// A model on a mesh, or at one point without space, as a problem for integrators (integrate/problem.hpp).
///
/// The object has scratch memory and permits one call at a time. A function in a boundary or a force must not
/// call it either.
///
/// On several processes every member function is collective. An error on one process does not end the
/// stage, because the others wait for its rows. The error is stored until throw_late_errors() throws it
/// on all processes.
class semidiscrete_problem {
 public:
  using state = field;  ///< f[cell][component]
  using real = double;  ///< type of time and coefficients

  /// `equation` must outlive the problem. T and Q are operators on `space`. `stages` is the equation that
  /// the collision solves.
  semidiscrete_problem(const model& equation, std::shared_ptr<domain> space, std::unique_ptr<transport> t,
                       std::unique_ptr<collision> q, stage_solution stages = stage_solution::implicit)
      : space_(std::move(space)),
        transport_(std::move(t)),
        has_transport_(equation.space_dimensions() > 0 || equation.has_source()),
        collision_(std::move(q)),
        cellwise_(collision_->as_cellwise()),
        stages_(stages) {}

  /// Adds a force to the transport. Throws input_error as force does.
  void set_force(acceleration of) { transport_->set_force(std::move(of)); }

  /// Adds the rotation of the velocities in axisymmetric flow; `radial` is the direction of r. Throws
  /// input_error as ring_rotation does.
  void set_rotation(int radial) { transport_->set_rotation(radial); }

  /// Adds a source to the transport of a model with space.
  void set_source(source_rate rate) { transport_->set_source(std::move(rate)); }

  /// For methods that treat T and Q explicitly and preserve the properties of u + Δt (T + Q). With 1/Δt =
  /// 1/Δt_T + 1/Δt_Q this sum is a convex combination of forward Euler steps of T and of Q.
  void treat_collision_explicitly() { explicit_collision_ = true; }

  /// acc ← (fresh ? 0 : acc) + α u + β T(t, u) for every target, with boundaries at time t.
  void add_transport(double t, const field& u, std::span<const target<field, double>> targets) {
    guarded(u, [&] { transport_->add_transport(t, u, targets); });
  }
  /// u ← v with v = u + a Q(v)/ε + b Q̇(v)/ε², or the exact solution after a time a if collides_exactly().
  /// Throws numerical_error if there is no equilibrium, or if Newton's method finds no solution.
  void solve_collision(double t, double a, double b, field& u) {
    guarded(u, [&] { collision_->solve(t, a, b, u); });
  }
  /// sum ← Σ_k α_k u_k, including padding, as required by `problem_with_combination`.
  void combine(std::span<const linear_term<field, double>> terms, field& sum) {
    guarded(sum, [&] { transport_->combine(terms, sum); });
  }
  /// u ← E(ℛu) up to rounding, for any ε. Averages become the limit of their stage solves.
  void project_to_equilibrium(double t, field& u) {
    solve_collision(t, time_to_equilibrium<double>(), 0.0, u);
  }
  /// Equivalent to add_transport() followed by solve_collision(due). If possible, cells are solved while they
  /// are in cache.
  void add_transport_and_solve(double t, const field& u, std::span<const target<field, double>> targets,
                               due_collision<field, double> due) {
    const auto collide_cells = [&](int begin, int end) {
      cellwise_->solve_cells(due.a, due.b, *due.u, begin, end);
    };
    if (cellwise_) cellwise_->prepare(*due.u);
    bool done = false;
    guarded(u, [&] {
      done = transport_->add_transport(t, u, targets, cellwise_ ? cells_job::of(collide_cells) : cells_job());
    });
    // If cells are independent, their collisions need no other process.
    if (!done && !(cellwise_ && failure_))
      guarded(u, [&] { collision_->solve(due.t, due.a, due.b, *due.u); });
  }
  /// acc ← (fresh ? 0 : acc) + α u + β Q(u)/ε for every target. Throws numerical_error if ε = 0 or there
  /// is no equilibrium.
  void add_collision(double t, const field& u, std::span<const target<field, double>> targets) {
    guarded(u, [&] { collision_->add_collision(t, u, targets); });
  }
  /// Returns the rates of a boundary_budget in the last evaluation of T, by add_transport() or
  /// add_transport_and_solve(). On several processes each one has the rates of its own ends. Only one process
  /// has those of force, rotation and source.
  std::span<const double> budget_rates() const { return transport_->budget_rates(); }
  /// Rethrows on all processes the first error since the last call, with the number of the cell in the whole
  /// mesh.
  void throw_late_errors() {
    if (space_->shared()) agree_on_errors(space_->processes(), failure_.take());
  }
  /// Returns face_fluxes::observed() at the ends of this process. Throws errors of boundaries
  /// and late errors.
  std::vector<double> observe_surfaces(double t, const field& u) {
    std::vector<double> found;
    guarded(u, [&] { found = transport_->observe_surfaces(t, u); });
    throw_late_errors();
    return found;
  }
  /// Returns the largest |∂S/∂u| of a source per unit of time; 0 if no source depends on u.
  double growth_of_source(double t, const field& u) const {
    if (!transport_->source_depends_on_state()) return 0.0;
    return -lowest([&] { return -transport_->growth_of_source(t, u); });
  }
  /// Returns true if there is a source that depends on u.
  bool source_depends_on_state() const { return transport_->source_depends_on_state(); }
  /// Returns Δt_FE of T, or of T + Q/ε after treat_collision_explicitly(); +infinity if nothing limits it. A
  /// source that depends on u adds |∂S/∂u| to 1/Δt_FE.
  double forward_euler_step(double t, const field& u) const {
    double of_transport = transport_->forward_euler_step();
    if (const double growth = growth_of_source(t, u); growth > 0.0)
      of_transport = 1.0 / (1.0 / of_transport + growth);
    if (!explicit_collision_) return of_transport;
    return 1.0 / (1.0 / of_transport +
                  1.0 / (rounding_allowance * lowest([&] { return collision_->forward_euler_step(u); })));
  }
  /// Returns dt/(r Δt_FE), at most 1: the part of the longest step for limit_for_steps(). It applies to a
  /// run with steps dt of a method with SSP coefficient r. Returns 1 if Δt_FE changes during a run, and for
  /// r ≤ 0.
  double share_of_longest_step(double r, double dt, double t, const field& u) const {
    if (explicit_collision_ || transport_->source_depends_on_state() || !(r > 0.0)) return 1.0;
    const double longest = r * forward_euler_step(t, u);
    return dt < longest ? dt / longest : 1.0;
  }
  /// Prepares for steps Δt ≤ share r Δt_FE, share ≤ 1, as transport::limit_for_steps() does.
  void limit_for_steps(double share) { transport_->limit_for_steps(share); }
  /// Prepares for a steady state instead, as transport::limit_for_steady_states() does.
  void limit_for_steady_states(double collisions) { transport_->limit_for_steady_states(collisions); }
  /// Required by `problem_with_exact_collision`.
  bool collides_exactly() const { return stages_ == stage_solution::exact; }
  /// Returns true if the model has space or a source.
  bool has_transport(double, const field&) const { return has_transport_; }
  /// Returns the smallest ε/C > 0; +infinity if it is unknown or ε = 0 everywhere.
  double relaxation_time(double, const field& u) const {
    return lowest([&] { return collision_->relaxation_time(u); });
  }
  /// Returns the largest relative change of the rate at which model::cut_moment() relaxes. It is that of all
  /// stages in cells of this process since the last call. Not collective.
  double take_cut() { return collision_->take_cut(); }

 private:
  /// Runs a part of a step over u. On several processes its errors wait for throw_late_errors().
  template <class Body>
  void guarded(const field& u, const Body& body) {
    const loops_over numbers(u.size());
    if (!space_->shared()) return body();
    failure_.run([&] {
      try {
        body();
      } catch (const numerical_error& failure) {
        failure_site site = failure.site();
        site.cell = space_->number_in_whole_mesh(site.cell);
        throw numerical_error(failure.problem(), site);
      }
    });
  }
  /// Returns the smallest value of a function over all processes. Throws an error of any process on all.
  template <class Function>
  double lowest(const Function& of) const {
    double mine = 0.0;
    run_collectively(space_->processes(), [&] { mine = of(); });
    return global_lowest(space_->processes(), mine);
  }

  std::shared_ptr<domain> space_;
  std::unique_ptr<transport> transport_;
  bool has_transport_;
  std::unique_ptr<collision> collision_;
  cellwise_collision* cellwise_;  ///< the collision if its cells are independent, else null
  stage_solution stages_;
  bool explicit_collision_ = false;
  first_error failure_;
};

}  // namespace apsis
