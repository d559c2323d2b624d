#pragma once

#include <apsis/semidiscrete/boundary_budget.hpp>
#include <apsis/semidiscrete/semidiscrete_problem.hpp>

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

namespace apsis {

/// The unknowns of a semi-discrete problem and the amounts that they have received.
struct budgeted_state {
  field unknowns;          ///< f[cell][component]
  boundary_budget budget;  ///< budget of the invariants since its last clear()
};

/// A semi-discrete problem with a boundary budget, for integrators of any kind. The budget obeys
///   G' = F(t, u)
/// with the rates F of semidiscrete_problem::budget_rates(); collisions do not change it. Every linear
/// combination of states is also applied to their budgets. A stage Σ_j (α_ij u_j + β_ij T(u_j)) thus has the
/// budget Σ_j (α_ij G_j + β_ij F_j).
///
/// The budget is part of the state, not of the integrator or the problem, because only the linear
/// combinations have the weights of the stages. Every integrator forms these combinations by the operations
/// of a problem (integrate/problem.hpp). This includes integrators that store sums of earlier states
/// (IMEX-BDF, two-step methods) or exchange states. Integrators therefore need no code for budgets.
/// Computations without a budget use the semi-discrete problem with plain fields.
class budgeted_problem {
 public:
  using state = budgeted_state;  ///< unknowns and budget
  using real = double;           ///< type of time and coefficients

  /// `equations` must outlive this object.
  explicit budgeted_problem(semidiscrete_problem& equations) : equations_(equations) {}

  /// acc ← (fresh ? 0 : acc) + α u + β T(t, u) for the unknowns, and the same with F for the budgets.
  void add_transport(double t, const state& u, std::span<const target<state, double>> targets) {
    equations_.add_transport(t, u.unknowns, targets_of_unknowns(targets));
    add_rates(u, targets);
  }
  /// Solves a stage of the unknowns, as semidiscrete_problem does.
  void solve_collision(double t, double a, double b, state& u) {
    equations_.solve_collision(t, a, b, u.unknowns);
  }
  /// sum ← Σ_k α_k u_k for unknowns and budgets.
  void combine(std::span<const linear_term<state, double>> terms, state& sum) {
    terms_.clear();
    for (const auto& [alpha, u] : terms) terms_.push_back({alpha, &u->unknowns});
    equations_.combine(terms_, sum.unknowns);
    for (std::size_t k = 0; k < terms.size(); ++k)
      sum.budget.combine(terms[k].alpha, terms[k].u->budget, 0.0, {}, k == 0);
  }
  /// Projects the unknowns, as semidiscrete_problem does.
  void project_to_equilibrium(double t, state& u) { equations_.project_to_equilibrium(t, u.unknowns); }
  /// Equivalent to add_transport() followed by solve_collision(due).
  void add_transport_and_solve(double t, const state& u, std::span<const target<state, double>> targets,
                               due_collision<state, double> due) {
    equations_.add_transport_and_solve(t, u.unknowns, targets_of_unknowns(targets),
                                       {due.t, due.a, due.b, &due.u->unknowns});
    add_rates(u, targets);
  }
  /// acc ← (fresh ? 0 : acc) + α u + β Q(u)/ε for the unknowns, and the same without the last term
  /// for the budgets.
  void add_collision(double t, const state& u, std::span<const target<state, double>> targets) {
    equations_.add_collision(t, u.unknowns, targets_of_unknowns(targets));
    combine_budgets(u, targets, {});
  }
  /// Throws the late errors of the problem.
  void throw_late_errors() { equations_.throw_late_errors(); }
  /// Returns Δt_FE of the problem.
  double forward_euler_step(double t, const state& u) const {
    return equations_.forward_euler_step(t, u.unknowns);
  }
  /// Required by `problem_with_exact_collision`.
  bool collides_exactly() const { return equations_.collides_exactly(); }
  /// Returns true if the model has space or a source.
  bool has_transport(double t, const state& u) const { return equations_.has_transport(t, u.unknowns); }
  /// Returns the smallest ε/C > 0, as semidiscrete_problem does.
  double relaxation_time(double t, const state& u) const { return equations_.relaxation_time(t, u.unknowns); }

 private:
  using targets_view = std::span<const target<state, double>>;

  std::span<const target<field, double>> targets_of_unknowns(targets_view targets) {
    targets_.clear();
    for (const auto& to : targets) targets_.push_back({&to.acc->unknowns, to.alpha, to.beta, to.fresh});
    return targets_;
  }

  void add_rates(const state& u, targets_view targets) {
    const bool moves =
        std::any_of(targets.begin(), targets.end(), [](const auto& to) { return to.beta != 0.0; });
    combine_budgets(u, targets, moves ? equations_.budget_rates() : std::span<const double>());
  }

  static void combine_budgets(const state& u, targets_view targets, std::span<const double> rates) {
    const auto combine = [&](const target<state, double>& to) {
      to.acc->budget.combine(to.alpha, u.budget, to.beta, rates, to.fresh);
    };
    for (const auto& to : targets)
      if (to.acc != &u) combine(to);
    for (const auto& to : targets)
      if (to.acc == &u) combine(to);  // after those that need its old value
  }

  semidiscrete_problem& equations_;
  std::vector<target<field, double>> targets_;     ///< scratch memory
  std::vector<linear_term<field, double>> terms_;  ///< scratch memory
};

}  // namespace apsis
