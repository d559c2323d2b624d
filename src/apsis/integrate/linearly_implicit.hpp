#pragma once

#include <apsis/core/errors.hpp>
#include <apsis/integrate/error_control.hpp>
#include <apsis/integrate/extrapolation.hpp>
#include <apsis/integrate/lane_matrix.hpp>
#include <apsis/integrate/lane_system.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>

#include <fmt/format.h>

namespace apsis {

/// Extrapolated linearly implicit Euler steps for ensembles. A step of length H from u₀ is taken with n = 1,
/// …, K substeps of length h = H/n,
///   (I − h J)(u_{k+1} − u_k) = h F(t_k, u_k) + h G(t_{k+1}, u_k),  J = G'(t₀, u₀).
/// Σ_n w_n u_n with w_n = Π_{m≠n} n/(n − m) has order K. The difference to the result without n = K, of order
/// K − 1, estimates the error. A step has one Jacobian matrix, K factorizations and K(K + 1)/2 solves, and no
/// iterations. Results may be negative: no step length preserves bounds. (Deuflhard, Hairer, Zugck, Numer.
/// Math. 51 (1987) 501; Hairer, Wanner, Solving Ordinary Differential Equations II, section IV.9.)
struct linearly_implicit {
  /// K, from 2 to 8. Without it K follows from the smallest rtol: it is 4 + ½ log₁₀ 1/rtol, rounded up. That
  /// is 6 for 1e-4, 7 for 1e-6, and 8 for 1e-8.
  std::optional<int> order = std::nullopt;
};

/// @cond
namespace ensemble_parts {

inline constexpr int least_extrapolation = 2, most_extrapolation = 8;

inline int order_of(const linearly_implicit& steps, double rtol) {
  if (!steps.order) {
    const double wanted = 4.0 + std::ceil(-0.5 * std::log10(std::clamp(rtol, 1e-16, 1.0)) - 1e-9);
    return static_cast<int>(std::min(wanted, double{most_extrapolation}));
  }
  if (*steps.order < least_extrapolation || *steps.order > most_extrapolation)
    throw input_error(
        fmt::format("the order of extrapolation is {} (it is from {} to {}); give one in this range",
                    *steps.order, least_extrapolation, most_extrapolation));
  return *steps.order;
}

/// Integrates groups by linearly implicit steps.
template <class System>
class linear_steps {
 public:
  using unknowns = typename System::unknowns;

  explicit linear_steps(int order) : order_(order) {
    for (int n = 1; n <= order; ++n) {
      of_result_[index(n)] = extrapolation_weight<double>(n, order);
      const double lower = n < order ? extrapolation_weight<double>(n, order - 1) : 0.0;
      of_error_[index(n)] = of_result_[index(n)] - lower;
    }
  }

  void operator()(System& system, unknowns& u, double t0, double t1) {
    time_marcher<double> march(t0, t1);
    step_controller<double> control(1.0, order_ - 1);
    bool accepted = true;
    while (!march.done()) {
      if (accepted) {
        collision_ = system.collision(march.t(), u, jacobian_);
        transport_ = system.transport(march.t(), u);
        if (march.step() == 0) control.start_with(first_step(system, u, t1 - t0));
      }
      const double dt = next_step(march, control);
      unknowns result;
      last_ = attempt(system, march.t(), dt, u, result);
      accepted = control.accepts(dt, last_.of_all());
      if (!accepted) continue;
      march.advance(dt);
      u = result;
    }
    system.counts.steps += march.step();
    system.counts.rejected += control.rejected();
  }

 private:
  static constexpr std::size_t size = std::tuple_size_v<unknowns>;
  static std::size_t index(int n) { return static_cast<std::size_t>(n) - 1; }

  /// The step in which u changes by tol^{1/K}, relative to u (first_step_length).
  double first_step(const System& system, const unknowns& u, double longest) const {
    unknowns rate;
    for (std::size_t i = 0; i < size; ++i) rate[i] = transport_[i] + collision_[i];
    const double of_state = system.in_tolerances(u, u, u).of_all(),
                 of_rate = system.in_tolerances(rate, u, u).of_all();
    const double dt = std::pow(std::max(of_state, 1.0), 1.0 - 1.0 / order_) / of_rate;
    return dt < longest ? dt : longest;
  }

  double next_step(const time_marcher<double>& march, const step_controller<double>& control) const {
    try {
      return march.next(control.proposed());
    } catch (const numerical_error& too_short) {
      failure_site site = too_short.site();
      site.cell = static_cast<long>(last_.worst());
      if (std::isfinite(last_.of_all())) throw numerical_error(too_short.problem(), site);
      throw numerical_error(
          "steps have no finite result, however short they are (a rate is not finite, or the solution ends "
          "here); check rates and data",
          site);
    }
  }

  /// Computes the result of a step, and returns its estimated error in units of the tolerances.
  largest_ratio attempt(System& system, double t, double dt, const unknowns& u, unknowns& result) {
    unknowns sum, error;
    sum.fill(0.0);
    error.fill(0.0);
    for (int n = 1; n <= order_; ++n) {
      const unknowns change = substeps(system, t, dt / n, n, u);
      for (std::size_t i = 0; i < size; ++i) {
        sum[i] += lanes(of_result_[index(n)]) * change[i];
        error[i] += lanes(of_error_[index(n)]) * change[i];
      }
    }
    for (std::size_t i = 0; i < size; ++i) result[i] = u[i] + sum[i];
    return system.in_tolerances(error, u, result);
  }

  /// Returns the change of u in n substeps of length h: it is small, and so are its rounding errors.
  unknowns substeps(System& system, double t, double h, int n, const unknowns& u) {
    matrix_.factorize_shifted(h, jacobian_);
    unknowns change, v = u;
    change.fill(0.0);
    for (int k = 0; k < n; ++k) {
      unknowns rate = system.collision(t + (k + 1) * h, v);
      const unknowns moved = k == 0 ? transport_ : system.transport(t + k * h, v);
      for (std::size_t i = 0; i < size; ++i) rate[i] = lanes(h) * (rate[i] + moved[i]);
      matrix_.solve(rate);
      for (std::size_t i = 0; i < size; ++i) {
        change[i] += rate[i];
        v[i] = u[i] + change[i];
      }
    }
    system.counts.solves += n;
    system.counts.iterations += n;
    return change;
  }

  int order_;
  std::array<double, most_extrapolation> of_result_{}, of_error_{};
  typename System::matrix jacobian_;
  unknowns collision_, transport_;
  lane_matrix<size> matrix_;
  largest_ratio last_;  ///< error of the last attempt
};

}  // namespace ensemble_parts
/// @endcond

}  // namespace apsis
