#pragma once

#include <apsis/core/errors.hpp>
#include <apsis/integrate/problem.hpp>
#include <apsis/integrate/schedule.hpp>
#include <apsis/integrate/step_estimate.hpp>
#include <apsis/method/convexity.hpp>
#include <apsis/method/method.hpp>

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

namespace apsis {

/// Solutions computed in a step: u^{n+1}, optionally with a second one for an estimate of its error.
enum class solutions { result, result_and_embedded };

/// Both solutions of a step; valid until the next step(), attempt() or accept() of the stepper.
template <class State>
struct attempted_step {
  const State &result,  ///< u^{n+1}
      &embedded;        ///< ũ, or the result of a single step where steps are doubled
};

/// Advances any problem by one step of any method, executing the schedule of the method. Buffers are
/// allocated at the first step as copies of the state.
template <problem P>
class stepper {
 public:
  using state = typename P::state;  ///< type of u
  using real = typename P::real;    ///< type of time and coefficients

  /// Copies the method and stores a reference to the problem, which must outlive the stepper. Throws
  /// input_error if the method evaluates Q explicitly and the problem cannot, or if only one of method and
  /// problem solves collisions exactly. A step of an implicit-only method throws input_error if the problem
  /// has transport (problem_with_transport_check). With result_and_embedded, a method without an embedded
  /// solution doubles steps: see step_estimate.
  stepper(const method& m, P& p, solutions which = solutions::result)
      : stepper(which == solutions::result_and_embedded && m.embedded
                    ? m.with_embedded_row().coefficients<real>()
                    : m.coefficients<real>(),
                m.kind, p, m.name, m.embedded ? which : solutions::result) {
    weight_ = static_cast<real>(estimate_of(m).weight);
    doubles_ = which == solutions::result_and_embedded && !m.embedded;
  }

  /// Takes coefficients that are not in a file, such as those of a method under design. With
  /// result_and_embedded, the last row is the embedded solution.
  stepper(shu_osher_form<real> coefficients, method_kind kind, P& p, const std::string& name = "method",
          solutions which = solutions::result)
      : problem_(p),
        name_(name),
        kind_(kind),
        m_(std::move(coefficients)),
        plan_(m_, which == solutions::result_and_embedded),
        initial_(initial_weights(m_)),
        convex_(is_convex(m_, kind, m_.stages() - (which == solutions::result_and_embedded ? 1 : 0))) {
    const auto butcher = to_butcher(m_);
    // Abscissae: time is a component of u with derivative 1. It is integrated as part of T if there is a T,
    // so that Q̇ has no ∂_t term, otherwise as part of Q (problem_with_timed_collision).
    const auto& a = kind == method_kind::implicit_only ? butcher.A : butcher.A_hat;
    for (std::size_t i = 0; i < m_.stages(); ++i) {
      real c(0);
      for (std::size_t j = 0; j <= i; ++j) c += a(i, j);
      abscissae_.push_back(c);
    }
    if constexpr (!problem_with_explicit_collision<P>) {
      if (plan_.collision_evaluations() > 0)
        throw input_error("method '" + name +
                          "' evaluates Q explicitly (some stage uses Q of a stage without "
                          "implicit part) and the problem has no add_collision; choose an IMEX method");
    }
    require_suitable_collisions();
  }

  /// Advances u = u^n at time t to u^{n+1}. Strong exception guarantee: if a stage throws, u is still u^n.
  void step(real t, real dt, state& u) {
    carry_out(whole_step_, t, dt, u);
    throw_late_errors(problem_);
    accept(u);
  }

  /// Computes u^{n+1} and the second solution from u = u^n without changing u. accept(u) takes the step; the
  /// next attempt discards it. Requires solutions::result_and_embedded.
  attempted_step<state> attempt(real t, real dt, state& u) {
    carry_out(whole_step_, t, dt, u);
    if (!doubles_) return {buffer(plan_.result_buffer(), u), buffer(plan_.embedded_buffer(), u)};
    using std::swap;
    while (kept_.size() < 2) kept_.push_back(u);
    state &single = kept_[0], &middle = kept_[1];
    const real half = dt / real(2);
    swap(single, buffer(plan_.result_buffer(), u));
    carry_out(first_half_, t, half, u);
    swap(middle, buffer(plan_.result_buffer(), u));
    carry_out(second_half_, t + half, half, middle);
    return {buffer(plan_.result_buffer(), u), single};
  }
  /// Sets u to the u^{n+1} of the last attempt. Requires that the attempt began with this u.
  void accept(state& u) {
    using std::swap;
    if (plan_.result_buffer() > 0) swap(u, buffer(plan_.result_buffer(), u));
  }

  /// Returns r of the Shu–Osher form: steps Δt ≤ r Δt_FE preserve what forward Euler steps of T preserve. If
  /// no form is convex (the SSP coefficient is 0), r is 1 and guarantees nothing.
  real r() const { return m_.r; }
  /// Returns r. Throws input_error if no form is convex, because then no step length is SSP.
  real require_ssp_coefficient() const {
    if (!convex_)
      throw input_error(
          "method '" + name_ +
          "' has no step length in units of the forward Euler step (its SSP coefficient is 0); give "
          "dt, or choose a method with an SSP coefficient");
    return m_.r;
  }
  /// Returns the factor of the estimated error of the method, 1 without a certificate.
  real weight_of_estimate() const { return weight_; }
  /// Whether collisions are explicit, so that steps resolve their relaxation times.
  bool resolves_collisions() const { return kind_ == method_kind::explicit_only; }
  const schedule& plan() const { return plan_; }  ///< schedule of a step
  P& problem() { return problem_; }               ///< the problem passed to the constructor

 private:
  using action = schedule::action;

  /// An instruction of the schedule for a given dt and address of u.
  struct prepared {
    action what;
    state* source;
    real delay;              ///< stage time minus t
    real a, b;               ///< coefficients of a stage solve
    std::size_t begin, end;  ///< range in the targets of the step
    bool due;    ///< the next instruction solves the stage of a target, and the problem can fuse both
    bool joint;  ///< T and Q have the same coefficients, and the problem can evaluate both together
  };

  /// The instructions of a step for the dt and the address of u of its last execution.
  struct prepared_step {
    std::vector<prepared> instructions;
    std::vector<target<state, real>> targets;
    real dt = real(0);
    const state *u = nullptr, *buffers = nullptr;  // a copy of a stepper has its own

    std::span<const target<state, real>> targets_of(const prepared& now) const {
      return std::span<const target<state, real>>(targets).subspan(now.begin, now.end - now.begin);
    }
  };

  /// Throws input_error if only one of method and problem solves collisions exactly.
  void require_suitable_collisions() const {
    const bool exact = collides_exactly(problem_);
    if (exact == solves_exactly(kind_)) return;
    const std::string suitable = to_string(method_kind::exact_collision);
    throw input_error(
        exact ? "method '" + name_ +
                    "' cannot integrate this problem (its collisions are solved exactly, and the method is "
                    "not " +
                    suitable + "); choose an " + suitable + " method"
              : "method '" + name_ + "' cannot integrate this problem (it is " + suitable +
                    ", and the collisions of the problem are not solved exactly); wrap the problem in "
                    "exact_collisions, or choose an IMEX method");
  }

  /// Throws input_error if the problem has a T that the method would ignore.
  void require_no_transport(real t, const state& u) {
    if constexpr (problem_with_transport_check<P>) {
      if (kind_ == method_kind::implicit_only && problem_.has_transport(t, u))
        throw input_error(
            "method '" + name_ +
            "' cannot integrate this problem (it is implicit only and the problem has transport); "
            "choose an IMEX or explicit method");
    }
  }

  void carry_out(prepared_step& plan, real t, real dt, state& u) {
    require_no_transport(t, u);
    while (static_cast<int>(buffers_.size()) + 1 < plan_.buffers()) buffers_.push_back(u);
    if (plan.instructions.empty() || dt != plan.dt || &u != plan.u || buffers_.data() != plan.buffers)
      prepare(plan, dt, u);
    const step_scope<P> scope(problem_, t, u);
    for (std::size_t i = 0; i < plan.instructions.size(); ++i) {
      const prepared& now = plan.instructions[i];
      if constexpr (problem_with_fused_stages<P>) {
        if (now.due) {
          problem_.add_transport_and_solve(t + now.delay, *now.source, plan.targets_of(now),
                                           collision_of(plan.instructions[i + 1], t));
          ++i;
          continue;
        }
      }
      execute(now, plan.targets_of(now), t);
    }
  }

  state& buffer(int b, state& u) { return b == 0 ? u : buffers_[static_cast<std::size_t>(b) - 1]; }

  void execute(const prepared& now, std::span<const target<state, real>> targets, real t) {
    if (now.what == action::solve_collision) {
      if constexpr (problem_with_timed_collision<P>) {
        if (kind_ == method_kind::implicit_only)
          return problem_.solve_timed_collision(t + now.delay, now.a, now.b, *now.source);
      }
      problem_.solve_collision(t + now.delay, now.a, now.b, *now.source);
    } else if (now.what == action::add_transport) {
      if constexpr (problem_with_joint_evaluation<P>) {
        if (now.joint) return problem_.add_transport_and_collision(t + now.delay, *now.source, targets);
      }
      problem_.add_transport(t + now.delay, *now.source, targets);
    } else if constexpr (problem_with_explicit_collision<P>) {
      problem_.add_collision(t + now.delay, *now.source, targets);
    }
  }

  due_collision<state, real> collision_of(const prepared& now, real t) const {
    return {t + now.delay, now.a, now.b, now.source};
  }

  /// Computes all coefficients that depend on dt; most runs have a single dt and a single u.
  void prepare(prepared_step& plan, real dt, state& u) {
    auto& prepared_instructions = plan.instructions;
    auto& targets = plan.targets;
    prepared_instructions.clear();
    targets.clear();
    for (const auto& from : plan_.instructions()) {
      const auto j = static_cast<std::size_t>(from.stage) - 1;
      prepared now{from.what, &buffer(from.buffer, u), real(0), real(0), real(0), targets.size(), 0, false,
                   false};
      if (from.stage > 0) now.delay = abscissae_[j] * dt;
      if (from.what == action::solve_collision) {
        now.a = dt * m_.D(j, j);
        now.b = dt * dt * m_.ddot[j];
      }
      for (const auto& to : from.to) targets.push_back(make_target(from, to, dt, u));
      now.end = targets.size();
      if (!prepared_instructions.empty()) {
        prepared& last = prepared_instructions.back();
        last.due = completes(plan, last, now);
        if (has_same_rates(plan, last, now)) {
          last.joint = true;
          targets.erase(targets.begin() + static_cast<std::ptrdiff_t>(now.begin), targets.end());
          continue;
        }
      }
      prepared_instructions.push_back(now);
    }
    plan.dt = dt;
    plan.u = &u;
    plan.buffers = buffers_.data();
  }

  /// Whether the stage solve `next` belongs to a target of `now`.
  static bool completes(const prepared_step& plan, const prepared& now, const prepared& next) {
    if (now.what != action::add_transport || now.joint || next.what != action::solve_collision) return false;
    const auto to = plan.targets_of(now);
    return std::any_of(to.begin(), to.end(), [&](const auto& one) { return one.acc == next.source; });
  }

  /// Whether the collisions of `next` have the targets and coefficients that the transport of `now` has, so
  /// that both can be evaluated together.
  static bool has_same_rates(const prepared_step& plan, const prepared& now, const prepared& next) {
    if (!problem_with_joint_evaluation<P> || now.joint || now.what != action::add_transport ||
        next.what != action::add_collision || now.source != next.source)
      return false;
    const auto moved = plan.targets_of(now), collided = plan.targets_of(next);
    auto collision = collided.begin();
    for (const auto& to : moved) {
      if (to.beta == real(0)) continue;
      if (collision == collided.end() || collision->acc != to.acc || collision->beta != to.beta) return false;
      ++collision;
    }
    return collision == collided.end();
  }

  target<state, real> make_target(const schedule::instruction& from, const schedule::contribution& to,
                                  real dt, state& u) {
    const std::size_t k = static_cast<std::size_t>(to.stage) - 1;
    const std::size_t j = static_cast<std::size_t>(from.stage) - 1;
    real alpha(0), beta(0);
    for (const auto term : to.terms) {
      switch (term) {
        case schedule::term::weight:
          alpha += from.stage == 0 ? initial_[k] : m_.P(k, j) + m_.W(k, j);
          if (from.stage > 0) beta += dt * (m_.W(k, j) / m_.r);
          break;
        case schedule::term::minus_explicit:
          alpha -= m_.D(k, j) / m_.D(j, j);
          break;
        case schedule::term::plus_solved:
          alpha += m_.D(k, j) / m_.D(j, j);
          break;
        case schedule::term::collision:
          beta += dt * m_.D(k, j);
          break;
      }
    }
    return {&buffer(to.buffer, u), alpha, beta, to.fresh};
  }

  P& problem_;
  std::string name_;
  method_kind kind_;
  shu_osher_form<real> m_;
  schedule plan_;
  std::vector<real> initial_, abscissae_;
  bool convex_;
  real weight_ = real(1);  ///< of the estimated error
  bool doubles_ = false;   ///< whether an attempt is a single step and two of half its length
  prepared_step whole_step_, first_half_, second_half_;
  std::vector<state> buffers_, kept_;  ///< kept_: the result of the single step, and of the first half
};

}  // namespace apsis
