#pragma once

#include <apsis/integrate/equal_steps.hpp>
#include <apsis/method/kinds/two_step.hpp>
#include <apsis/method/time_integrator.hpp>

#include <string>
#include <utility>
#include <vector>

namespace apsis {

/// Advances any problem by a two-step method with equal steps. As soon as u_j is known, T(u_j) is evaluated
/// once and added to the accumulators of all later rows. No T is stored. Buffers are allocated at the first
/// step.
///
/// The first two steps, from u⁰ to u², are steps of a method of one step, because u⁰ may be far from
/// equilibrium. T(u⁰) would enter the formula with the weight Δt, although an initial layer lasts only ε.
template <problem P>
class two_step {
 public:
  using state = typename P::state;  ///< type of u
  using real = typename P::real;    ///< type of time and coefficients

  /// Copies the method and the method of the first steps, whose order may be one below that of `m`. Stores a
  /// reference to the problem, which must outlive this object.
  two_step(const method& m, const method& starter, P& p)
      : problem_(p),
        name_(m.name),
        m_(m.coefficients<real>()),
        initial_(initial_weights(m_)),
        starter_(starter, p) {
    abscissae_.push_back(real(-1));
    for (std::size_t i = 1; i < m_.stages(); ++i) {
      real c(0);
      for (std::size_t j = 0; j < i; ++j) c += (m_.P(i, j) + m_.W(i, j)) * abscissae_[j] + m_.W(i, j) / m_.r;
      abscissae_.push_back(c);
    }
  }

  int first_steps() const { return 2; }       ///< number of steps of the starter
  std::string name() const { return name_; }  ///< name of the method
  stepper<P>& starter() { return starter_; }  ///< method of the first two steps
  real r() const { return m_.r; }             ///< steps up to r Δt_FE preserve convex properties

  /// Records u^{n−1}.
  void add(real, real, const state& u) {
    allocate(u);
    rows_[0] = u;
    known_ = 1;
  }

  /// Advances u from t to t + dt. Requires u^{n−1}, recorded or of the last step. If a stage throws, u and
  /// u^{n−1} are still the old values.
  void step(real t, real dt, state& u) {
    allocate(u);
    const std::size_t last = m_.stages() - 1;
    add_initial(t, u);
    add_row(0, t, dt);
    for (std::size_t i = 1; i <= last; ++i) {
      if (!solved_)
        problem_.solve_collision(t + abscissae_[i] * dt, dt * m_.D(i, i), dt * dt * m_.ddot[i], rows_[i]);
      solved_ = false;
      if (i < last) add_row(i, t, dt);
    }
    throw_late_errors(problem_);
    using std::swap;
    swap(rows_[0], u);
    swap(u, rows_[last]);
    known_ = 1;
  }

  /// Discards u^{n−1}.
  void restart() { known_ = 0; }

  long known() const { return known_; }  ///< 1 if u^{n−1} is known, else 0
  /// Calls visit(u^{n−1}, 1) if it is known.
  template <class Visit>
  void visit_kept(const Visit& visit) {
    if (known_ > 0) visit(rows_[0], real(1));
  }
  /// Continues with u^{n−1} if `known` is 1: visit_kept() then gives its place.
  void resume(long known, const state& like) {
    known_ = known;
    allocate(like);
  }

 private:
  void allocate(const state& u) {
    while (rows_.size() < m_.stages()) rows_.push_back(u);
  }

  /// Begins every accumulator with r_i u^n.
  void add_initial(real t, const state& u) {
    solved_ = false;
    targets_.clear();
    for (std::size_t i = 1; i < m_.stages(); ++i) targets_.push_back({&rows_[i], initial_[i], real(0), true});
    problem_.add_transport(t, u, targets_);
  }

  /// Adds (p_ij + w_ij) u_j + (w_ij Δt/r) T(u_j) to the accumulators of the rows i that use u_j. Solves row j
  /// + 1 in the same pass if the problem can and this completes the row.
  void add_row(std::size_t j, real t, real dt) {
    targets_.clear();
    bool next = false;
    for (std::size_t i = j + 1; i < m_.stages(); ++i) {
      const real weight = m_.P(i, j) + m_.W(i, j);
      if (weight == real(0)) continue;
      targets_.push_back({&rows_[i], weight, dt * (m_.W(i, j) / m_.r), false});
      next = next || i == j + 1;
    }
    if (targets_.empty()) return;
    const real now = t + abscissae_[j] * dt;
    if constexpr (problem_with_fused_stages<P>) {
      if (next) {
        const std::size_t k = j + 1;
        problem_.add_transport_and_solve(
            now, rows_[j], targets_,
            {t + abscissae_[k] * dt, dt * m_.D(k, k), dt * dt * m_.ddot[k], &rows_[k]});
        solved_ = true;
        return;
      }
    }
    problem_.add_transport(now, rows_[j], targets_);
  }

  P& problem_;
  std::string name_;
  shu_osher_form<real> m_;
  std::vector<real> initial_, abscissae_;
  stepper<P> starter_;
  std::vector<state> rows_;  ///< u^{n−1}, and the accumulators and values of the rows
  std::vector<target<state, real>> targets_;
  bool solved_ = false;  ///< whether the next row is solved already
  long known_ = 0;       ///< number of earlier values that are known
};

/// Entry of stepper_kinds.
struct two_step_steps {
  static constexpr const char* kind = "two-step";  ///< integrator_kind_entry::name
  /// Returns use(march).
  template <problem P, class Use>
  static auto with(const time_integrator& m, P& p, solutions, const Use& use) {
    return use(two_step<P>(*m.file(), m.starter(), p));
  }
};

}  // namespace apsis
