#pragma once

#include <apsis/core/errors.hpp>
#include <apsis/integrate/verbs.hpp>
#include <apsis/method/rate_errors.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <string>

namespace apsis {

/// Loss of a method with steps Δt in the terms of size ε (docs/plateaus.md), relative to the state. All
/// values are estimates of first order in the deviation D from equilibrium.
template <class Real>
struct rate_loss {
  Real rate{},      ///< error of the moments per unit of time, ‖E′ℛT′(E) (flux(z) − 1) D‖
      diffusion{},  ///< effect of D on the moments per unit of time, ‖E′ℛT′(E) D‖
      change{},     ///< change of the moments per unit of time, by transport and by D
      result{},     ///< error of the deviation from equilibrium in u, ‖(last(z) − 1) D‖
      deviation{};  ///< deviation from equilibrium, ‖D‖
  Real layer{};     ///< error of the moments by the initial layer; 0 where it was not requested
};

/// @cond
namespace rate_loss_parts {

/// Estimates the loss at one state. It owns all state-sized buffers.
template <problem P, class Distance>
class probe {
 public:
  using real = typename P::real;
  using state = typename P::state;
  using coefficients = std::array<double, rate_response::terms>;

  probe(P& p, real t, const state& u, real dt, const Distance& distance)
      : p_(p), t_(t), dt_(dt), u_(u), distance_(distance), equilibrium_(u), spare_(u), from_(u) {
    project_to_equilibrium(p_, t_, equilibrium_);
  }

  rate_loss<real> operator()(const rate_response& response, bool with_layer) {
    rate_loss<real> loss;
    const state base = transported(equilibrium_);
    state moved = base;
    project_to_equilibrium(p_, t_ + dt_, moved);
    coefficients whole;
    whole.fill(1.0);  // Σ_k (1 − s) s^k D = (1 − s^terms) D
    state part = deviations(base, moved, whole, true);
    if (!find_size(part)) return loss;
    loss.deviation = size(part);
    loss.diffusion = effect(part, moved) / dt_;
    add(real(-1), equilibrium_, spare_);  // the change of the moments in a step with D
    loss.change = size(spare_) / dt_;
    part = deviations(base, moved, response.flux, true);
    loss.rate = effect(part, moved) / dt_;
    part = deviations(base, moved, response.last, true);
    add(real(response.last_growth), moved, part);  // zD, before any solve
    add(real(-response.last_growth), base, part);
    loss.result = size(part);
    if (with_layer) {
      part = deviations(u_, equilibrium_, response.layer, false);
      loss.layer = effect(part, moved);
    }
    return loss;
  }

 private:
  /// sum ← sum + α u
  void add(real alpha, const state& u, state& sum) { combine(p_, {{real(1), &sum}, {alpha, &u}}, sum); }

  /// Returns M + Δt T(v) with the equilibrium M of u.
  state transported(const state& v) {
    state sum = equilibrium_;
    const target<state, real> moved{&sum, real(0), dt_, false};
    p_.add_transport(t_, v, {&moved, 1});
    return sum;
  }

  /// Returns Σ_k c_k (end − v_k), where v_k is `from` after k solves, or k + 1 if `solved_first`.
  state deviations(const state& from, const state& end, const coefficients& c, bool solved_first) {
    state now = from, sum = u_;
    real all(0);
    for (std::size_t k = 0; k < c.size(); ++k) {
      if (k > 0 || solved_first) p_.solve_collision(t_ + dt_, dt_, real(0), now);
      if (k == 0)
        combine(p_, {{real(-c[k]), &now}}, sum);
      else
        add(real(-c[k]), now, sum);
      all += real(c[k]);
    }
    add(all, end, sum);
    return sum;
  }

  /// Stores the larger of the sizes of u and of the slow solution M − D, because u may vanish at the start.
  /// Returns false if both vanish.
  bool find_size(const state& deviation) {
    state zero = u_, slow = equilibrium_;
    combine(p_, {{real(0), &u_}}, zero);
    add(real(-1), deviation, slow);
    const real of_u = distance_(u_, zero);
    size_ = std::max(of_u, distance_(slow, zero));
    if (!(of_u > real(0))) from_ = slow;
    return size_ > real(0);
  }

  /// Returns ‖change‖/‖u‖, for distances that are relative to their first argument.
  real size(const state& change) {
    state shifted = from_;
    add(real(1), change, shifted);
    return distance_(from_, shifted) / size_;
  }

  /// Returns the size of the change that a deviation x causes in the equilibrium after Δt. Leaves the changed
  /// equilibrium in spare_.
  real effect(const state& x, const state& moved) {
    state deviating = equilibrium_;
    add(real(-1), x, deviating);
    spare_ = transported(deviating);
    project_to_equilibrium(p_, t_ + dt_, spare_);
    state difference = moved;
    add(real(-1), spare_, difference);
    return size(difference);
  }

  P& p_;
  real t_, dt_, size_{};
  const state& u_;
  const Distance& distance_;
  state equilibrium_, spare_, from_;  // from_: a state that does not vanish
};

}  // namespace rate_loss_parts
/// @endcond

/// Estimates at state u the error of the O(ε) terms of a method with this response and steps dt. It takes up
/// to four evaluations of T and repeated implicit Euler solves. With the equilibrium M of u, M + Δt T(M)
/// deviates from equilibrium by zD, and every solve divides this by 1 + z. `distance` is that of
/// error_estimate; `with_layer` includes the initial layer of u. Returns nothing if a solve fails: the run
/// itself reports invalid data.
template <problem P, class Distance>
std::optional<rate_loss<typename P::real>> compute_rate_loss(P& p, typename P::real t,
                                                             const typename P::state& u, typename P::real dt,
                                                             const rate_response& response,
                                                             const Distance& distance, bool with_layer) {
  try {
    return rate_loss_parts::probe<P, Distance>(p, t, u, dt, distance)(response, with_layer);
  } catch (const numerical_error&) {
    return std::nullopt;
  }
}

/// Consequence of a loss for a run.
struct loss_verdict {
  double expected = 0.0,  ///< estimated relative error
      rate = 0.0;         ///< rate_loss::rate if it counts, otherwise 0
  bool large = false;     ///< whether it is worth a warning
};

/// Judges a loss from now on, for a `rest` of the time; `done` is the error of the moments so far. A loss
/// counts if the terms of size ε are wrong by more than a twentieth. It accumulates over the rest of the
/// time, or until the moments have changed by their own size if that is shorter: later states have other
/// losses. It is large if the expected error exceeds 10⁻³ and, in a run to a tolerance, 30 tolerances. It is
/// also large if the error of the moments exceeds 10⁻⁵ and their rate is wrong by a tenth of all that changes
/// them.
loss_verdict judge_loss(const rate_loss<double>& loss, double done, double rest,
                        std::optional<double> tolerance);

/// Returns the first half of a warning: "method 'NAME' is unfit for steps of … (…)".
std::string describe_loss(const std::string& method, const rate_loss<double>& loss, double t, double dt,
                          double end, double expected);

}  // namespace apsis
