#pragma once

#include <apsis/integrate/equal_steps.hpp>
#include <apsis/method/kinds/imex_dimsim.hpp>
#include <apsis/method/time_integrator.hpp>

#include <string>
#include <utility>
#include <vector>

namespace apsis {

/// Advances any problem by an IMEX-DIMSIM of order p: p evaluations of T and p stage solves for each step. Q
/// is not evaluated: Δt Q(U_i) = (U_i − R_i)/λ, where R_i is the explicit part of stage i. Every T(U_i) is
/// evaluated once and added to the sums that contain it; no T is stored.
///
/// The first p + 1 steps, from u⁰ to u^{p+1}, are steps of equal length of the extrapolated Euler method of
/// order p (family extrapolated-euler-S). The first y_i follow from u¹ … u^{p+1} and their T. They do not
/// contain u⁰, which may be far from equilibrium.
template <problem P>
class imex_dimsim {
 public:
  using state = typename P::state;  ///< type of u
  using real = typename P::real;    ///< type of time and coefficients

  /// Stores a reference to the problem, which must outlive this object. Throws input_error unless p is 2
  /// or 3.
  imex_dimsim(int p, P& problem)
      : problem_(problem),
        m_(imex_dimsim_coefficients(p).in<real>()),
        start_(compute_starting_weights(m_)),
        starter_(find_integrator("imex-dimsim-" + std::to_string(p)).starter(), problem) {}

  int order() const { return static_cast<int>(m_.stages()); }  ///< p
  int first_steps() const { return order() + 1; }              ///< number of steps before the formula holds
  std::string name() const { return "IMEX-DIMSIM"; }           ///< for messages
  stepper<P>& starter() { return starter_; }                   ///< method of the first p + 1 steps

  /// Adds a value u at time t to an empty or incomplete history, Δt after the last one.
  void add(real t, real dt, const state& u) {
    allocate(u);
    const std::size_t s = m_.stages(), l = s - static_cast<std::size_t>(known_);  // u is u^{n−l}
    targets_.clear();
    for (std::size_t i = 0; i < s; ++i)
      targets_.push_back({&values_[i], start_.alpha(i, l), dt * start_.beta(i, l), known_ == 0});
    problem_.add_transport(t, u, targets_);
    ++known_;
  }

  /// Advances u from t to t + dt. Requires a history of p values with equal steps before u, or an earlier
  /// step that ended at u. If a stage solve throws, u is still the old value, and restart() is required.
  void step(real t, real dt, state& u) {
    const std::size_t s = m_.stages();
    if (known_ == order()) add(t, dt, u);
    set_new_values();
    for (std::size_t i = 0; i < s; ++i) {
      add_stage(t, i, -1, real(0));
      problem_.solve_collision(t + m_.c[i] * dt, dt * m_.lambda(), real(0), values_[i]);
      add_stage(t + m_.c[i] * dt, i, 1, dt);
    }
    throw_late_errors(problem_);
    using std::swap;
    swap(u, values_.back());
    swap(values_, new_values_);
  }

  /// Discards the history.
  void restart() { known_ = 0; }

  long known() const { return known_; }  ///< number of values added since restart(), at most p + 1
  /// Calls visit(y_i, w) for every handed-on value. It is a sum of earlier u, with weights that add up to w,
  /// and of their transport.
  template <class Visit>
  void visit_kept(const Visit& visit) {
    const std::size_t s = m_.stages(), known = static_cast<std::size_t>(known_);
    for (std::size_t i = 0; i < s && known > 0; ++i) {
      real sum(0);
      for (std::size_t l = s + 1 - known; l <= s; ++l) sum += start_.alpha(i, l);
      visit(values_[i], known > s ? real(1) : sum);
    }
  }
  /// Continues from a history of `known` values: visit_kept() then visits the places of the y_i.
  void resume(long known, const state& like) {
    known_ = known;
    allocate(like);
  }

 private:
  void allocate(const state& like) {
    while (values_.size() < m_.stages()) values_.push_back(like);
    while (new_values_.size() < m_.stages()) new_values_.push_back(like);
  }

  /// Begins every new value with Σ_j v_j y_j.
  void set_new_values() {
    for (std::size_t j = 0; j < m_.stages(); ++j) {
      targets_.clear();
      for (state& sum : new_values_) targets_.push_back({&sum, m_.v[j], real(0), j == 0});
      problem_.add_transport(real(0), values_[j], targets_);
    }
  }

  /// Adds the explicit part of stage i (sign −1, dt 0) or its solution and T to the sums of later stages and
  /// of the new values.
  void add_stage(real t, std::size_t i, int sign, real dt) {
    targets_.clear();
    const real per_solve = real(sign) / m_.lambda();
    for (std::size_t k = i + 1; k < m_.stages(); ++k)
      targets_.push_back({&values_[k], m_.A(k, i) * per_solve, dt * m_.A_hat(k, i), false});
    for (std::size_t k = 0; k < m_.stages(); ++k)
      targets_.push_back({&new_values_[k], m_.B(k, i) * per_solve, dt * m_.B_hat(k, i), false});
    problem_.add_transport(t, values_[i], targets_);
  }

  P& problem_;
  multistage_formula<real> m_;
  starting_weights<real> start_;
  stepper<P> starter_;
  std::vector<state> values_,  ///< y_i; during a step R_i, then U_i
      new_values_;
  std::vector<target<state, real>> targets_;
  long known_ = 0;  ///< number of values added; p + 1 once the y_i are complete
};

/// Entry of stepper_kinds.
struct imex_dimsim_steps {
  static constexpr const char* kind = "imex-dimsim";  ///< integrator_kind_entry::name
  /// Returns use(march).
  template <problem P, class Use>
  static auto with(const time_integrator& m, P& p, solutions, const Use& use) {
    return use(imex_dimsim<P>(m.order, p));
  }
};

}  // namespace apsis
