#pragma once

#include <apsis/integrate/equal_steps.hpp>
#include <apsis/method/kinds/imex_bdf.hpp>
#include <apsis/method/time_integrator.hpp>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace apsis {

/// Advances any problem by IMEX-BDF: one evaluation of T and one stage solve for each step. As soon as u^n is
/// known, T(u^n) is evaluated once and added to the accumulators of the next k steps. No T is stored.
///
/// The first k steps, from u⁰ to u^k, are steps of equal length of the extrapolated Euler method of order k
/// (family extrapolated-euler-S). The formula uses u¹ … u^k but not u⁰, which may be far from equilibrium:
/// T(u⁰) would enter with the weight Δt, although an initial layer lasts only ε.
template <problem P>
class imex_bdf {
 public:
  using state = typename P::state;  ///< type of u
  using real = typename P::real;    ///< type of time and coefficients

  /// Stores a reference to the problem, which must outlive this object. Throws input_error unless 1 ≤ k ≤ 5.
  imex_bdf(int k, P& p)
      : problem_(p),
        m_(imex_bdf_coefficients<real>(k)),
        starter_(find_integrator("imex-bdf-" + std::to_string(k)).starter(), p) {}

  int order() const { return m_.steps(); }         ///< k
  int first_steps() const { return m_.steps(); }   ///< number of steps before the formula holds
  std::string name() const { return "IMEX-BDF"; }  ///< for messages
  stepper<P>& starter() { return starter_; }       ///< method of the first k steps

  /// Adds a value u at time t to an empty or incomplete history, Δt after the last one.
  void add(real t, real dt, const state& u) {
    set_targets(dt, u);
    problem_.add_transport(t, u, targets_);
    ++known_;
  }

  /// Advances u from t to t + dt. Requires a history of k − 1 values with equal steps before u. If the stage
  /// solve throws, u is still the old value, and restart() is required.
  void step(real t, real dt, state& u) {
    set_targets(dt, u);
    state& next = *accumulator(1);
    if constexpr (problem_with_fused_stages<P>) {
      problem_.add_transport_and_solve(t, u, targets_, {t + dt, dt * m_.b, real(0), &next});
    } else {
      problem_.add_transport(t, u, targets_);
      problem_.solve_collision(t + dt, dt * m_.b, real(0), next);
    }
    throw_late_errors(problem_);
    using std::swap;
    swap(u, next);
    ++known_;
  }

  /// Discards the history.
  void restart() { known_ = 0; }

  long known() const { return known_; }  ///< number of values in the history since restart()
  /// Calls visit(v, w) for every state v that later steps need in addition to u. v is a sum of earlier u,
  /// with weights that add up to w, and of their transport.
  template <class Visit>
  void visit_kept(const Visit& visit) {
    for (int i = 1; i < order() && known_ > 0; ++i) {
      real sum(0);
      for (long j = i + 1; j <= std::min<long>(order(), i + known_); ++j)
        sum += m_.a[static_cast<std::size_t>(j - 1)];
      visit(*accumulator(i), sum);
    }
  }
  /// Continues from a history of `known` values: visit_kept() then visits the places of the stored values.
  void resume(long known, const state& like) {
    known_ = known;
    allocate(like);
  }

 private:
  /// Returns the accumulator of the value i steps after the next known one.
  state* accumulator(int i) {
    return &accumulators_[static_cast<std::size_t>(known_ + i) % accumulators_.size()];
  }

  /// Sets the targets of the next known value: the accumulators of the k values after it. The last of these
  /// reuses the accumulator of the known value itself.
  void set_targets(real dt, const state& u) {
    allocate(u);
    targets_.clear();
    for (int i = 1; i <= order(); ++i) {
      const auto k = static_cast<std::size_t>(i - 1);
      targets_.push_back({accumulator(i), m_.a[k], dt * m_.c[k], i == order() || known_ == 0});
    }
  }

  void allocate(const state& like) {
    while (static_cast<int>(accumulators_.size()) < order()) accumulators_.push_back(like);
  }

  P& problem_;
  linear_formula<real> m_;
  stepper<P> starter_;
  std::vector<state> accumulators_;
  std::vector<target<state, real>> targets_;
  long known_ = 0;  ///< number of values in the history
};

/// Entry of stepper_kinds.
struct imex_bdf_steps {
  static constexpr const char* kind = "imex-bdf";  ///< integrator_kind_entry::name
  /// Returns use(march).
  template <problem P, class Use>
  static auto with(const time_integrator& m, P& p, solutions, const Use& use) {
    return use(imex_bdf<P>(m.order, p));
  }
};

}  // namespace apsis
