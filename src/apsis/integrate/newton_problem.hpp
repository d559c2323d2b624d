#pragma once

#include <apsis/core/errors.hpp>
#include <apsis/core/log.hpp>
#include <apsis/integrate/array_state.hpp>
#include <apsis/integrate/autodiff.hpp>
#include <apsis/integrate/component_tolerances.hpp>
#include <apsis/integrate/guarded_newton.hpp>
#include <apsis/integrate/mass_matrix.hpp>
#include <apsis/integrate/newton_stage.hpp>
#include <apsis/integrate/problem.hpp>
#include <apsis/integrate/simplified_newton.hpp>
#include <apsis/integrate/stage_preconditioner.hpp>
#include <apsis/integrate/unsquared_newton.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace apsis {

/// u' = F(t, u) + G(u) for any smooth G. Automatic differentiation gives G' and Ġ = G'G. A guarded Newton
/// method (guarded_newton.hpp) solves the stages v = u + a G(v) + b Ġ(v). F is explicit, G implicit; all
/// quantities are dimensionless. The functions, with N = u.size():
///   f(t, u, out)   out ← F(t, u) on states; no_transport{} if F = 0
///   g(u, out)      out ← G(u) for any scalar type, on std::span of N numbers:
///                  [](const auto& u, auto& out) { out[0] = -10 * u[0] * u[0]; }
///   g(t, u, out)   instead, for G that depends on time; t has the scalar type of u
/// g may also be an object with derivatives written by hand (`differentiated`, autodiff.hpp).
/// newton_problem{f, g} has the state std::vector<double>, make_newton_problem<State>(f, g) any other.
///
/// with_mass(M) makes it M u' = F(t, u) + G(u).
///
/// A stage with d = 0 and ḋ < 0 is singular where Δt λ = ±i/√|ḋ| for an eigenvalue λ of G'. This cannot occur
/// for real negative spectra (relaxation). For other G it is detected and reported.
template <class F, class G, array_state State = std::vector<double>>
class newton_problem {
 public:
  using state = State;             ///< type of u
  using real = state_real<State>;  ///< number type of u

  /// Stores f and g as above.
  newton_problem(F f, G g, newton_options options = {})
      : f_(std::move(f)), equation_(std::move(g)), options_(options) {}

  /// Sets Δt_FE(t, u) of F for the property to be preserved; without it the step is unlimited.
  newton_problem& with_forward_euler_step(std::function<real(real, const State&)> step) {
    forward_euler_ = std::move(step);
    return *this;
  }

  /// Sets the admissible set, such as that of positive states. Newton iterates do not leave it; a stage
  /// outside it is a numerical_error.
  newton_problem& with_admissible(std::function<bool(std::span<const real>)> admissible) {
    equation_.admissible_set = std::move(admissible);
    return *this;
  }

  /// Ends the stage solves as soon as Newton's correction is below `share` of the tolerance of every unknown,
  /// instead of at rounding errors. Quantities that G conserves stay conserved to rounding. Stages with b = 0
  /// then share the derivative of their step (simplified_newton.hpp). The default allows for extrapolated
  /// Euler steps, which multiply errors of their solves by up to 300. Throws input_error unless 0 < share ≤
  /// 1.
  newton_problem& with_tolerances(component_tolerances<real> tolerances, real share = real(1e-3)) {
    if (!(share > real(0) && share <= real(1)))
      throw input_error(
          "the share of the tolerance is not between 0 and 1 (it is that of stage solves); "
          "give a small part of 1");
    equation_.tolerances = std::move(tolerances);
    equation_.share = share;
    return *this;
  }

  /// Solves stages by sparse factorizations (sparse_newton): G' has entries at the places of the pattern
  /// only. Throws input_error after with_preconditioner().
  newton_problem& with_sparsity(const sparsity_pattern& pattern) {
    if (equation_.preconditioner) refuse_both();
    places_ = pattern;
    choose_matrices();
    return *this;
  }

  /// Solves stages by matrix-free GMRES with a preconditioner, whatever the options are. `prepare`
  /// (t, v, γ) returns a function (r, x) that sets x ≈ (M − γ G'(t, v))⁻¹ r, such as a multigrid cycle. It is
  /// called once for each γ of a step, and again where GMRES does not converge. γ is a, or √−b for b < 0
  /// (stage_preconditioner.hpp). Throws input_error without a function, or after with_sparsity().
  newton_problem& with_preconditioner(shifted_solves<real> prepare) {
    if (!prepare)
      throw input_error("the preconditioner is empty (it must be callable); give a function of t, v and γ");
    if (places_) refuse_both();
    equation_.preconditioner = stage_preconditioner<real>(std::move(prepare));
    options_.solver = linear_solver::krylov;
    return *this;
  }

  /// Makes the system M u' = F(t, u) + G(u). F and G are functions of u as before, but Δt_FE is that of
  /// u' = M⁻¹ F, and what G conserves is conserved by M u. Stage systems with a sparsity pattern get the
  /// places of M, too. M does not change, and stages of another number of unknowns throw input_error.
  newton_problem& with_mass(mass_matrix<real> mass) {
    equation_.mass_of_rates = std::move(mass);
    choose_matrices();
    return *this;
  }

  /// Required by `problem`, with T = F. Throws input_error if F has another size than u, numerical_error if
  /// it is not finite.
  void add_transport(real t, const State& u, std::span<const target<State, real>> targets) {
    accumulate<State>(targets, u, [&]() -> const State& {
      work_ = u;
      f_(t, u, work_);
      require_size(work_, u, "the transport");
      require_finite(work_, "the transport");  // stages of explicit methods have no other check
      divide_by_mass(work_);
      return work_;
    });
  }

  /// Required by `problem_with_explicit_collision`, with Q = G.
  void add_collision(real t, const State& u, std::span<const target<State, real>> targets) {
    accumulate<State>(targets, u, [&]() -> const State& {
      load(u);
      equation_.field.set_time(t, real(0));
      equation_.field.value(v_, equation_.g);
      work_ = u;
      unload(equation_.g, work_);
      require_finite(work_, "the collision");
      divide_by_mass(work_);
      return work_;
    });
  }

  /// Required by `problem_with_joint_evaluation`.
  void add_transport_and_collision(real t, const State& u, std::span<const target<State, real>> targets) {
    accumulate<State>(targets, u, [&]() -> const State& {
      work_ = u;
      f_(t, u, work_);
      require_size(work_, u, "the transport");
      load(u);
      equation_.field.set_time(t, real(0));
      equation_.field.value(v_, equation_.g);
      using size_type = decltype(u.size());
      for (std::size_t i = 0; i < v_.size(); ++i) work_[static_cast<size_type>(i)] += equation_.g[i];
      require_finite(work_, "the sum of transport and collision");
      divide_by_mass(work_);
      return work_;
    });
  }

  /// Sets u ← v. Throws numerical_error as guarded_newton does, or if u is not finite or not admissible; u
  /// is then unchanged.
  void solve_collision(real t, real a, real b, State& u) { solve(t, real(0), a, b, u); }

  /// Required by `problem_with_timed_collision`; throws like solve_collision().
  void solve_timed_collision(real t, real a, real b, State& u)
    requires field_of<real, G>::timed
  {
    solve(t, real(1), a, b, u);
  }

  /// Required by `problem_with_steps`: stages with b = 0 of a step share a derivative, if there are
  /// tolerances.
  void begin_step(real t, const State& u) {
    equation_.preconditioner.begin_step();
    if (!equation_.tolerances) return;
    load(u);
    simplified_.begin_step(t, v_);
  }
  /// Required by `problem_with_steps`.
  void end_step() { simplified_.end_step(); }

  /// Required by `problem_with_transport_check`; evaluates F.
  bool has_transport(real t, const State& u) {
    if constexpr (std::is_same_v<F, no_transport>) {
      return false;
    } else {
      work_ = u;
      f_(t, u, work_);
      require_size(work_, u, "the transport");
      return !is_zero(work_);
    }
  }

  /// Returns Δt_FE of F; +infinity unless set.
  real forward_euler_step(real t, const State& u) const {
    return forward_euler_ ? forward_euler_(t, u) : std::numeric_limits<real>::infinity();
  }

  /// Required by `problem_with_admissible_set`; true unless a set is given.
  bool is_admissible(const State& u) {
    load(u);
    return equation_.admissible(v_);
  }

  /// Report on the last stage solve.
  const newton_report& report() const { return report_; }

 private:
  /// Solves the stage at time t. Time advances at the rate θ along the flow of G.
  void solve(real t, real theta, real a, real b, State& u) {
    load(u);
    equation_.field.set_time(t, theta);
    if (a == real(0) && b == real(0)) {
      require_finite(u, "a stage");
      if (!equation_.admissible(v_))
        throw numerical_error(
            "a stage is not admissible (the method or the time step does not preserve admissibility); "
            "reduce the time step, or use an SSP method");
      return;
    }
    warn_of_cost();
    require_size_of_mass(v_.size());
    equation_.t = t;
    equation_.theta = theta;
    equation_.a = a;
    equation_.b = b;
    equation_.explicit_part = v_;
    if (b == real(0) || !is_far_from_equilibrium() || !solve_from_implicit_euler()) {
      if (!solve_by_kept_derivative()) report_ = solve_from_start();
    }
    unload(v_, u);
  }

  [[noreturn]] static void refuse_both() {
    throw input_error(
        "a problem has a sparsity pattern and a preconditioner (sparse systems are factorized, without "
        "iterations); give one of them");
  }

  newton_report solve_from_start() {
    return sparse_ ? sparse_->solve(equation_, v_, options_) : guarded_newton<real>(equation_, v_, options_);
  }

  /// Returns whether G changes an unknown by more than its size in the time √−b of the second derivative. The
  /// stage equation then has other roots than the one that short steps lead to. Newton's method may find one
  /// of them, for example near a zero of G'.
  bool is_far_from_equilibrium() {
    using std::abs, std::sqrt;
    equation_.field.value(v_, equation_.g);
    if (equation_.mass_of_rates) equation_.mass_of_rates->divide(equation_.g);
    const real time = sqrt(-equation_.b);
    for (std::size_t i = 0; i < v_.size(); ++i)
      if (abs(time * equation_.g[i]) > abs(v_[i])) return true;
    return false;
  }

  /// Solves the stage from the solution of an implicit Euler step. Returns whether that is possible; v_ is
  /// the explicit part otherwise.
  bool solve_from_implicit_euler() {
    using std::sqrt;
    const real a = equation_.a, b = equation_.b;
    equation_.a = std::max(a, sqrt(-b));
    equation_.b = real(0);
    bool found = try_from_start();
    equation_.a = a;
    equation_.b = b;
    found = found && try_from_start();
    if (!found) v_ = equation_.explicit_part;
    return found;
  }
  bool try_from_start() {
    try {
      report_ = solve_from_start();
      return true;
    } catch (const numerical_error&) {
      return false;
    }
  }

  /// Solves the stage by simplified_newton if its errors have a tolerance and the solver factorizes matrices.
  /// Returns whether that is possible and succeeds.
  bool solve_by_kept_derivative() {
    if (!equation_.tolerances || equation_.b != real(0)) return false;
    const bool factorizes =
        sparse_ || options_.solver == linear_solver::dense ||
        (options_.solver == linear_solver::automatic && v_.size() <= options_.dense_limit);
    if (!factorizes || (sparse_ && !sparse_->fits(v_.size()))) return false;
    const auto found = simplified_.solve(equation_, equation_.t, v_);
    if (found) report_ = *found;
    return found.has_value();
  }

  /// Sets up the matrices of stages for the pattern and the mass matrix.
  void choose_matrices() {
    const auto& mass = equation_.mass_of_rates;
    std::optional<sparsity_pattern> places = places_;
    if (places && mass) places = places->joined_with(mass->places());
    if (places) sparse_.emplace(*places, mass);
    simplified_ = simplified_newton<real>(std::move(places), mass);
  }

  /// Sets x ← M⁻¹ x.
  void divide_by_mass(State& x) {
    if (!equation_.mass_of_rates) return;
    require_size_of_mass(static_cast<std::size_t>(x.size()));
    using size_type = decltype(x.size());
    std::vector<real>& k = equation_.moved;
    k.resize(static_cast<std::size_t>(x.size()));
    for (std::size_t i = 0; i < k.size(); ++i) k[i] = x[static_cast<size_type>(i)];
    equation_.mass_of_rates->divide(k);
    unload(k, x);
  }
  void require_size_of_mass(std::size_t n) const {
    if (const auto& mass = equation_.mass_of_rates; mass && mass->size() != n)
      throw input_error("the mass matrix has " + std::to_string(mass->size()) + " rows and the state " +
                        std::to_string(n) +
                        " unknowns (they differ in number); give the matrix of this system");
  }

  /// Warns once, before the first solve.
  void warn_of_cost() {
    if (sparse_ || options_.solver != linear_solver::dense || warned_ || !options_.warns_of_cost ||
        v_.size() <= most_unknowns_of_newton)
      return;
    warned_ = true;
    const double n = static_cast<double>(v_.size());
    char text[320];
    std::snprintf(
        text, sizeof text,
        "a stage has %.0f unknowns, and each of its Newton steps takes about n^3 = %.0e operations (dense "
        "linear systems); use with_sparsity, with_preconditioner, linear_solver::krylov if G is not stiff, "
        "or relaxation_problem, "
        "whose "
        "stages are closed formulas",
        n, n * n * n);
    log::warning(text);
  }

  void load(const State& u) {
    using size_type = decltype(u.size());
    const std::size_t n = static_cast<std::size_t>(u.size());
    v_.resize(n);
    equation_.g.resize(n);
    equation_.g_dot.resize(n);
    for (std::size_t i = 0; i < n; ++i) v_[i] = u[static_cast<size_type>(i)];
  }

  static void unload(const std::vector<real>& from, State& u) {
    using size_type = decltype(u.size());
    for (std::size_t i = 0; i < from.size(); ++i) u[static_cast<size_type>(i)] = from[i];
  }

  F f_;
  newton_stage<real, G> equation_;
  newton_options options_;
  std::optional<sparsity_pattern> places_;
  std::optional<sparse_newton<real>> sparse_;
  simplified_newton<real> simplified_;
  bool warned_ = false;  ///< of the cost of dense systems
  newton_report report_;
  std::function<real(real, const State&)> forward_euler_;
  State work_{};
  std::vector<real> v_;
};

/// @cond
template <class F, class G>
newton_problem(F, G) -> newton_problem<F, G>;
template <class F, class G>
newton_problem(F, G, newton_options) -> newton_problem<F, G>;
/// @endcond

/// Makes a newton_problem with a state other than std::vector<double>.
template <array_state State, class F, class G>
auto make_newton_problem(F f, G g, newton_options options = {}) {
  return newton_problem<F, G, State>(std::move(f), std::move(g), options);
}

}  // namespace apsis
