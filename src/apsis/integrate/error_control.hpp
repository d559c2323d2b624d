#pragma once

#include <apsis/integrate/error_estimate.hpp>
#include <apsis/integrate/integrate.hpp>
#include <apsis/method/step_law.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace apsis {

/// Step-size controller: keeps the estimated error err of a step below a tolerance. A step is rejected if err
/// > tol. Errors grow like err ~ Δt^k, where k is the order of the embedded solution plus one. The longest
/// step that would have been accepted is L_n = Δt_n (tol/err_n)^{1/k}. The next step is
/// - 0.9 L_n after a rejected step, but at least 0.2 times the last one;
/// - that of a step_law after an accepted one, between 0.2 times and twice the last one, and not longer right
/// after a rejection.
/// The default law is Gustafsson's predictive controller. It expects a decrease of L to continue, as where
/// steps approach ε, but not an increase, as after a layer.
template <class Real>
class step_controller {
 public:
  /// State of the controller in a checkpoint; a restart from it is bitwise identical.
  struct progress {
    Real proposed = std::numeric_limits<Real>::infinity();  ///< proposed length of the next step
    Real longest = Real(0);                                 ///< L_n of the last accepted step; 0 if none
    Real length = Real(0);                                  ///< its Δt_n
    Real earlier = Real(1);                                 ///< ℓ of the accepted step before it
    bool after_rejection = false;                           ///< whether the last step was rejected
    long rejected = 0;                                      ///< number of rejected steps

    /// Calls visit(name, member) for every member of `self`.
    template <class Self, class Visitor>
    static void visit_members(Self& self, Visitor&& visit) {
      visit("proposed", self.proposed);
      visit("longest", self.longest);
      visit("length", self.length);
      visit("earlier", self.earlier);
      visit("after_rejection", self.after_rejection);
      visit("rejected", self.rejected);
    }
  };

  /// `tolerance` has the unit of the errors, `order` is that of the embedded solution, k − 1. Throws
  /// input_error unless the tolerance is positive and finite.
  step_controller(Real tolerance, int order, step_law law = find_step_law(std::string(usual_step_law)))
      : tolerance_(tolerance), order_(order), law_(std::move(law)) {
    if (!(tolerance > Real(0)) || !(tolerance < std::numeric_limits<Real>::infinity()))
      throw input_error(
          "the tolerance is not a positive number (errors are compared with it); give one above 0");
  }

  /// Returns tolerance and order.
  error_target<Real> target() const { return {tolerance_, order_}; }
  /// Returns the proposed length of the next step; initially +infinity.
  Real proposed() const { return now_.proposed; }
  /// Sets the length of the first step; no effect once a step has been proposed.
  void start_with(Real dt) {
    if (!(now_.proposed < std::numeric_limits<Real>::infinity())) now_.proposed = dt;
  }
  long rejected() const { return now_.rejected; }  ///< number of rejected steps

  /// Accepts or rejects a step of length dt with this estimated error, and updates the proposed step.
  bool accepts(Real dt, Real error) {
    using std::pow;
    const Real k(order_ + 1), ratio = error / tolerance_;
    const bool good = ratio <= Real(1);
    if (good) {
      const Real longest = dt * pow(std::max(ratio, Real(1e-4)), Real(-1) / k);  // finite for err = 0
      const Real most = now_.after_rejection ? Real(1) : Real(2);
      now_.proposed = std::clamp(by_law(dt, longest), Real(0.2) * dt, most * dt);
      now_.earlier = factor_before();
      now_.longest = longest;
      now_.length = dt;
    } else {
      const bool is_number = ratio < std::numeric_limits<Real>::infinity();
      const Real factor = is_number ? Real(0.9) * pow(ratio, Real(-1) / k) : Real(0);
      now_.proposed = dt * std::max(factor, Real(0.2));
      ++now_.rejected;
    }
    now_.after_rejection = !good;
    return good;
  }

  progress save() const { return now_; }                ///< returns the state for a checkpoint
  void resume(const progress& saved) { now_ = saved; }  ///< restores the state of an earlier run

 private:
  /// ℓ of the last accepted step; 1 before the first.
  Real factor_before() const {
    return now_.longest > Real(0) ? Real(0.9) * now_.longest / now_.length : Real(1);
  }
  /// Returns the Δt_{n+1} of the law after an accepted step n of length dt with this L_n.
  Real by_law(Real dt, Real longest) const {
    using std::pow;
    const bool first = !(now_.longest > Real(0));
    if (law_.predictive) {
      const Real trend = first ? Real(1) : std::min(longest / now_.longest, Real(1));
      return Real(0.9) * longest * trend;
    }
    const Real factor = Real(0.9) * longest / dt, quotient = first ? Real(1) : dt / now_.length;
    return dt * pow(factor, Real(law_.beta[0])) * pow(factor_before(), Real(law_.beta[1])) *
           pow(now_.earlier, Real(law_.beta[2])) * pow(quotient, Real(-law_.alpha));
  }

  Real tolerance_;
  int order_;
  step_law law_;
  progress now_;
};

/// Throws numerical_error if the problem has an admissible set and u is not in it.
template <problem P>
void require_admissible(P& p, const typename P::state& u) {
  if constexpr (problem_with_admissible_set<P>) {
    if (!p.is_admissible(u))
      throw numerical_error(
          "the result of a step is not admissible (the method does not preserve admissibility, and shorter "
          "steps did not either); begin with an admissible state, or use an SSP method");
  }
}

/// Takes one accepted step of length `limit` at most: u ← u^{n+1}. Returns its length. The caller chooses
/// distance(u, v), a norm of u − v, and `estimate` computes the error in it. A step is rejected, like one
/// with infinite error, if it fails with a numerical_error or its result is not admissible. Once steps are
/// too small to advance time, that numerical_error is thrown, and u is still u^n.
template <problem P, class Distance>
typename P::real step_within_tolerance(stepper<P>& method_stepper,
                                       const time_marcher<typename P::real>& march,
                                       step_controller<typename P::real>& control,
                                       error_estimate<P>& estimate, typename P::real limit,
                                       typename P::state& u, const Distance& distance) {
  using real = typename P::real;
  std::optional<numerical_error> failure;
  while (true) {
    real dt(0);
    try {
      dt = march.next(std::min(limit, control.proposed()));
    } catch (const numerical_error&) {
      if (failure) throw *failure;
      throw;
    }
    try {
      const auto tried = method_stepper.attempt(march.t(), dt, u);
      require_admissible(method_stepper.problem(), tried.result);
      const real error = estimate(method_stepper.problem(), march.t(), dt, u, tried, distance);
      if (!control.accepts(dt, error)) continue;
    } catch (const numerical_error& why) {
      failure = why;
      control.accepts(dt, std::numeric_limits<real>::infinity());
      continue;
    }
    method_stepper.accept(u);
    return dt;
  }
}

/// Sets the first step of a controller without a proposed step to first_step_length(). With startup::graded
/// it is at most longest_first_step(ε/C), so that steps resolve the initial layer to the tolerance. `longest`
/// limits every step. Throws input_error for a graded start of a problem without relaxation_time.
template <problem P, class Distance>
void start_control(P& p, typename P::real t, const typename P::state& u, typename P::real longest,
                   const step_rule<typename P::real>& rule, step_controller<typename P::real>& control,
                   const Distance& distance) {
  using real = typename P::real;
  if (control.proposed() < std::numeric_limits<real>::infinity()) return;
  real dt = first_step_length(p, t, u, longest, control.target(), distance);
  if (rule.start == startup::graded)
    dt = std::min(dt, longest_first_step(initial_layer(p, t, u), rule.growth));
  control.start_with(dt);
}

/// Integrates u from t0 to t1 like integrate(), with steps chosen by `control`. The rule, including a given
/// dt, is an upper limit; step_rule::unlimited() sets no limit. start_control() sets the first step of a
/// controller without one. The stepper must compute solutions::result_and_embedded. Throws like integrate()
/// and step_within_tolerance().
template <problem P, class Distance, class Observer = no_observer>
integration_result<typename P::real> integrate_to_tolerance(stepper<P>& method_stepper, typename P::state& u,
                                                            typename P::real t0, typename P::real t1,
                                                            step_rule<typename P::real> rule,
                                                            step_controller<typename P::real>& control,
                                                            const Distance& distance,
                                                            Observer&& observer = {}) {
  using real = typename P::real;
  error_estimate<P> estimate(method_stepper.weight_of_estimate(), method_stepper.resolves_collisions());
  const time_marcher<real> march(t0, t1);
  if (!march.done()) {
    const real limit = rule_limit(method_stepper, rule, t0, u);
    start_control(method_stepper.problem(), t0, u, std::min(limit, t1 - t0), rule, control, distance);
  }
  const auto take = [&](const time_marcher<real>& now, real limit, typename P::state& state) {
    return step_within_tolerance(method_stepper, now, control, estimate, limit, state, distance);
  };
  return integrate_with(take, method_stepper, march, u, rule.with(startup::none), observer);
}

}  // namespace apsis
