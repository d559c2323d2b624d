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

/// A model on a mesh, or at one point without space, as a problem of the integrator (integrate/problem.hpp).
///
/// It has scratch memory: one call at a time, also where a function in a boundary or a force calls again.
///
/// On several processes every member function is collective. An error on one of them does not end the stage,
/// in which the others wait for its rows: it is kept until throw_late_errors(), which throws it on all.
class semidiscrete_problem {
 public:
  using state = field;  ///< f[cell][component]
  using real = double;  ///< type of time and coefficients

  /// `equation` must outlive the problem; T and Q are operators on `space`; `stages`: the stages that the
  /// collision solves.
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

  /// Adds the rotation of the velocities in axisymmetric flow, where `radial` is the direction of r. Throws
  /// input_error as rotation does.
  void set_rotation(int radial) { transport_->set_rotation(radial); }

  /// Adds a source to the transport, of a model with space.
  void set_source(source_rate rate) { transport_->set_source(std::move(rate)); }

  /// For methods that treat T and Q explicitly and preserve the properties of u + Δt (T + Q). With 1/Δt =
  /// 1/Δt_T + 1/Δt_Q this is a convex combination of forward Euler steps of T and of Q.
  void treat_collision_explicitly() { explicit_collision_ = true; }

  /// acc ← (fresh ? 0 : acc) + α u + β T(t, u) for every target, with boundaries at time t.
  void add_transport(double t, const field& u, std::span<const target<field, double>> targets) {
    guarded(u, [&] { transport_->add_transport(t, u, targets); });
  }
  /// u ← v with v = u + a Q(v)/ε + b Q̇(v)/ε², or the exact solution after a time a if it collides_exactly().
  /// Throws numerical_error where there is no equilibrium, or Newton's method finds no solution.
  void solve_collision(double t, double a, double b, field& u) {
    guarded(u, [&] { collision_->solve(t, a, b, u); });
  }
  /// sum ← Σ_k α_k u_k, with padding, as required by `problem_with_combination`.
  void combine(std::span<const linear_term<field, double>> terms, field& sum) {
    guarded(sum, [&] { transport_->combine(terms, sum); });
  }
  /// u ← E(ℛu) up to rounding, whatever ε; of averages, what their stage solves lead to.
  void project_to_equilibrium(double t, field& u) {
    solve_collision(t, time_to_equilibrium<double>(), 0.0, u);
  }
  /// Equivalent to add_transport() followed by solve_collision(due); where possible, cells are solved while
  /// they are in cache.
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
    // Collisions of cells that are independent need no other process.
    if (!done && !(cellwise_ && failure_))
      guarded(u, [&] { collision_->solve(due.t, due.a, due.b, *due.u); });
  }
  /// acc ← (fresh ? 0 : acc) + α u + β Q(u)/ε for every target. Throws numerical_error where ε = 0
  /// or there is no equilibrium.
  void add_collision(double t, const field& u, std::span<const target<field, double>> targets) {
    guarded(u, [&] { collision_->add_collision(t, u, targets); });
  }
  /// Returns the rates of a boundary_budget in the last evaluation of T, by add_transport() or
  /// add_transport_and_solve(). On several processes each has those of its own ends, and one those of force,
  /// rotation and source.
  std::span<const double> budget_rates() const { return transport_->budget_rates(); }
  /// Rethrows on all processes the first error since the last call, with the number of the cell in the whole
  /// mesh.
  void throw_late_errors() {
    if (space_->shared()) agree_on_errors(space_->processes(), failure_.take());
  }
  /// Returns face_fluxes::observed() at the ends of this process. Throws what boundaries throw, and late
  /// errors.
  std::vector<double> observe_surfaces(double t, const field& u) {
    std::vector<double> found;
    guarded(u, [&] { found = transport_->observe_surfaces(t, u); });
    throw_late_errors();
    return found;
  }
  /// Returns the largest |∂S/∂u| of a source, per unit of time; 0 without one that depends on u.
  double growth_of_source(double t, const field& u) const {
    if (!transport_->source_depends_on_state()) return 0.0;
    return -lowest([&] { return -transport_->growth_of_source(t, u); });
  }
  /// Whether there is a source that depends on u.
  bool source_depends_on_state() const { return transport_->source_depends_on_state(); }
  /// Δt_FE of T, or that of T + Q/ε after treat_collision_explicitly(); +infinity if nothing limits it. A
  /// source that depends on u limits it by 1/|∂S/∂u|.
  double forward_euler_step(double t, const field& u) const {
    double of_transport = transport_->forward_euler_step();
    if (const double growth = growth_of_source(t, u); growth > 0.0)
      of_transport = 1.0 / (1.0 / of_transport + growth);
    if (!explicit_collision_) return of_transport;
    return 1.0 / (1.0 / of_transport +
                  1.0 / (rounding_allowance * lowest([&] { return collision_->forward_euler_step(u); })));
  }
  /// Returns dt/(r Δt_FE), at most 1: the share of the longest step for limit_for_steps() in a run of steps
  /// dt of a method with SSP coefficient r. 1 where Δt_FE changes during a run, and for r ≤ 0.
  double share_of_longest_step(double r, double dt, double t, const field& u) const {
    if (explicit_collision_ || transport_->source_depends_on_state() || !(r > 0.0)) return 1.0;
    const double longest = r * forward_euler_step(t, u);
    return dt < longest ? dt / longest : 1.0;
  }
  /// For steps Δt ≤ share r Δt_FE from now on, share ≤ 1: as transport::limit_for_steps().
  void limit_for_steps(double share) { transport_->limit_for_steps(share); }
  /// Required by `problem_with_exact_collision`.
  bool collides_exactly() const { return stages_ == stage_solution::exact; }
  /// Whether the model has space or a source.
  bool has_transport(double, const field&) const { return has_transport_; }
  /// Smallest ε/C > 0; +infinity where none is known, or ε = 0 everywhere.
  double relaxation_time(double, const field& u) const {
    return lowest([&] { return collision_->relaxation_time(u); });
  }
  /// Returns the largest relative change of the rate at which model::cut_moment() relaxes, of all stages in
  /// cells of this process since the last call. Not collective.
  double take_cut() { return collision_->take_cut(); }

 private:
  /// Runs a part of a step over u; on several processes its errors wait for throw_late_errors().
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
  /// Returns the smallest value of a function over all processes, with the errors of all.
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
  cellwise_collision* cellwise_;  ///< the collision if its cells are independent; else null
  stage_solution stages_;
  bool explicit_collision_ = false;
  first_error failure_;
};

}  // namespace apsis
