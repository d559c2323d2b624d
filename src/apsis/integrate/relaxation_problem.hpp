#pragma once

#include <apsis/core/errors.hpp>
#include <apsis/core/relaxation_flow.hpp>
#include <apsis/core/relaxation_weights.hpp>
#include <apsis/integrate/array_state.hpp>
#include <apsis/integrate/problem.hpp>

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstdio>
#include <functional>
#include <iterator>
#include <limits>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace apsis {

/// u' = T(t, u) + C(ω) (E(ω) − u)/ε with conserved moments ω = ℛu, ℛE(ω) = ω (paper, Properties 3–5). This is
/// the simplest problem to define. Since Q̇ = −(C/ε) Q and ω does not change, every stage v = u + a Q(v) + b
/// Q̇(v) is a convex combination of u and E in closed form: v = (u + μE)/(1 + μ), μ = a C/ε + |b| (C/ε)². v is
/// nonnegative wherever u and E are, in floating point too, and equals E for ε = 0.
///
/// The first two evaluations of E check ℛE(ω) = ω to 1e-8 of the largest moment if ω is a number or a range
/// of numbers. An E that does not have the moments ω ends the step with an input_error, and so do rates that
/// do not conserve them.
///
/// All quantities are dimensionless. The functions, with N = u.size():
///   transport(t, u, out)   out ← T(t, u); `out` has size N and undefined content
///   moments(u)             ω, of any type (a number, a range, a struct)
///   equilibrium(ω, out)    out ← E(ω); `out` has size N and undefined content
///   rate(ω)                C(ω) ≥ 0
///   rate(ω, out)           instead, out ← C for each unknown, equal where moments couple unknowns: systems
///                          side by side, such as the cells of a mesh, each with its own C/ε
/// relaxation_problem{…} has the state std::vector<double>, make_relaxation_problem<State>(…) any other.
template <class Transport, class Moments, class Equilibrium, class Rate,
          array_state State = std::vector<double>>
class relaxation_problem {
 public:
  using state = State;             ///< type of u
  using real = state_real<State>;  ///< number type of u

  /// Throws input_error unless ε ≥ 0 is finite.
  relaxation_problem(Transport transport, Moments moments, Equilibrium equilibrium, Rate rate, real epsilon)
      : transport_(std::move(transport)),
        moments_(std::move(moments)),
        equilibrium_(std::move(equilibrium)),
        rate_(std::move(rate)),
        epsilon_(epsilon) {
    if (!(epsilon >= real(0)) || !(epsilon <= std::numeric_limits<real>::max()))
      throw input_error("epsilon is negative or not finite; give epsilon ≥ 0 (0 is the limit scheme)");
  }

  /// Sets Δt_FE(t, u) of the transport for the property to be preserved; without it the step is unlimited.
  relaxation_problem& with_forward_euler_step(std::function<real(real, const State&)> step) {
    forward_euler_ = std::move(step);
    return *this;
  }

  /// Sets a predicate that every stage must satisfy; otherwise the step throws a numerical_error.
  relaxation_problem& with_admissible(std::function<bool(const State&)> admissible) {
    admissible_ = std::move(admissible);
    return *this;
  }

  /// Required by `problem_with_admissible_set`; true unless a predicate is given.
  bool is_admissible(const State& u) const { return !admissible_ || admissible_(u); }

  /// Required by `problem`. Throws input_error if T has another size than u, numerical_error if it is not
  /// finite.
  void add_transport(real t, const State& u, std::span<const target<State, real>> targets) {
    accumulate<State>(targets, u, [&]() -> const State& {
      match_size(u);
      transport_(t, u, work_);
      require_size(work_, u, "the transport");
      require_finite(work_, "the transport");  // stages of explicit methods have no other check
      return work_;
    });
  }

  /// Sets u ← v. Throws numerical_error if u or v is not finite or not admissible, or if the rate is negative
  /// or not finite.
  void solve_collision(real, real a, real b, State& u) {
    if (a != real(0) || b != real(0)) mix(u, [&](real rate) { return relax_weights(a, b, rate, epsilon_); });
    require_valid(u);
  }

  /// Required by `problem_with_projection`. Throws like solve_collision().
  void project_to_equilibrium(real, State& u) {
    mix(u, [](real rate) {
      const real of_e = rate > real(0) ? real(1) : real(0);
      return relaxation_weights<real>{real(1) - of_e, of_e};
    });
    require_valid(u);
  }

  /// Required by `problem_with_known_collision`: u ← e^{−z}u + (1 − e^{−z})E, z = sC/ε. Throws like
  /// solve_collision().
  void advance_collision(real, real s, State& u) {
    mix(u, [&](real rate) { return flow_weights(s, rate, epsilon_); });
    require_valid(u);
  }

  /// Required by `problem_with_explicit_collision`. Throws input_error for ε = 0, where Q is not
  /// defined off equilibrium.
  void add_collision(real, const State& u, std::span<const target<State, real>> targets) {
    accumulate<State>(targets, u, [&]() -> const State& {
      const real k = finite_relaxation(u);
      using size_type = decltype(u.size());
      for (size_type i = 0; i < u.size(); ++i) work_[i] = relaxation_of(i, k) * (work_[i] - u[i]);
      require_finite(work_, "the collision");
      return work_;
    });
  }

  /// Required by `problem_with_joint_evaluation`. Throws like add_collision().
  void add_transport_and_collision(real t, const State& u, std::span<const target<State, real>> targets) {
    accumulate<State>(targets, u, [&]() -> const State& {
      const real k = finite_relaxation(u);
      if (flow_.size() != u.size()) flow_ = u;
      transport_(t, u, flow_);
      require_size(flow_, u, "the transport");
      using size_type = decltype(u.size());
      for (size_type i = 0; i < u.size(); ++i) flow_[i] += relaxation_of(i, k) * (work_[i] - u[i]);
      require_finite(flow_, "the sum of transport and collision");
      return flow_;
    });
  }

  /// Returns Δt_FE of the transport; +infinity unless set.
  real forward_euler_step(real t, const State& u) const {
    return forward_euler_ ? forward_euler_(t, u) : std::numeric_limits<real>::infinity();
  }

  /// Required by `problem_with_transport_check`; evaluates T.
  bool has_transport(real t, const State& u) {
    if constexpr (std::is_same_v<Transport, no_transport>) {
      return false;
    } else {
      match_size(u);
      transport_(t, u, work_);
      require_size(work_, u, "the transport");
      return !is_zero(work_);
    }
  }

  /// Required by `problem_with_relaxation_time`: the smallest ε/C; +infinity if nothing relaxes, and for ε =
  /// 0, where there is no layer to resolve.
  real relaxation_time(real, const State& u) {
    const real rate = largest_rate(moments_(u), u);
    return rate > real(0) && epsilon_ > real(0) ? epsilon_ / rate : std::numeric_limits<real>::infinity();
  }

  real epsilon() const { return epsilon_; }  ///< ε

 private:
  using moments_type = std::remove_cvref_t<std::invoke_result_t<Moments&, const State&>>;
  /// Whether each unknown has a rate of its own.
  static constexpr bool many_rates = std::is_invocable_v<Rate&, const moments_type&, State&>;

  /// Sets the rates C(ω), one or many, and returns the largest of them.
  real largest_rate(const moments_type& omega, const State& u) {
    if constexpr (many_rates) {
      if (rates_.size() != u.size()) rates_ = u;
      rate_(omega, rates_);
      require_size(rates_, u, "the rate");
      real largest(0);
      using size_type = decltype(u.size());
      for (size_type i = 0; i < u.size(); ++i) largest = std::max(largest, checked_rate(rates_[i]));
      return largest;
    } else {
      return checked_rate(rate_(omega));
    }
  }
  static real checked_rate(real rate) {
    if (!(rate >= real(0)) || !(rate <= std::numeric_limits<real>::max()))
      throw numerical_error(
          "the relaxation rate is negative or not finite (the moments are not admissible); "
          "reduce the time step, or check the functions of the problem",
          {-1, std::nan(""), -1, static_cast<double>(rate)});
    return rate;
  }

  /// Sets u ← of_u u + of_e E(ℛu) with the weights for C(ℛu).
  template <class Weights>
  void mix(State& u, const Weights& weights_for) {
    const real rate = relaxation(u);
    using size_type = decltype(u.size());
    if constexpr (many_rates) {
      for (size_type i = 0; i < u.size(); ++i) {
        const auto weights = weights_for(real(rates_[i]));
        u[i] = weights.of_u * u[i] + weights.of_e * work_[i];
      }
    } else {
      const auto weights = weights_for(rate);
      for (size_type i = 0; i < u.size(); ++i) u[i] = weights.of_u * u[i] + weights.of_e * work_[i];
    }
  }

  /// Throws numerical_error unless u is finite and admissible.
  void require_valid(const State& u) const {
    require_finite(u, "a stage");  // implies a finite explicit part: neither weight turns a NaN into a number
    if (!is_admissible(u))
      throw numerical_error(
          "a stage is not admissible (the method or the time step does not preserve admissibility); "
          "use Δt ≤ r Δt_FE with an SSP method");
  }

  void match_size(const State& u) {
    if (work_.size() != u.size()) work_ = u;
  }

  /// work_ ← E(ℛu), and sets the rates; returns the largest C/ε.
  real finite_relaxation(const State& u) {
    if (epsilon_ == real(0))
      throw input_error(
          "epsilon = 0 and the method evaluates Q explicitly (Q is infinite off equilibrium); "
          "choose a method of type A, which is implicit at every stage");
    return relaxation(u) / epsilon_;
  }
  /// Returns C/ε of unknown i. `largest` is that of all unknowns.
  template <class Index>
  real relaxation_of([[maybe_unused]] Index i, [[maybe_unused]] real largest) const {
    if constexpr (many_rates)
      return real(rates_[i]) / epsilon_;
    else
      return largest;
  }

  /// work_ ← E(ℛu), and sets the rates; returns the largest.
  real relaxation(const State& u) {
    const auto omega = moments_(u);
    const real rate = largest_rate(omega, u);
    match_size(u);
    equilibrium_(omega, work_);
    require_size(work_, u, "the equilibrium");
    if (unchecked_ > 0) {
      --unchecked_;
      real size(0);
      using size_type = decltype(work_.size());
      for (size_type i = 0; i < work_.size(); ++i) size += std::abs(real(work_[i]));
      check_moments(omega, moments_(work_), size,
                    "the equilibrium does not have the given moments (R E(w) differs from w by {} of the "
                    "largest); correct the equilibrium or the moments");
      if constexpr (many_rates) check_rates(omega, u, rate, size);
    }
    return rate;
  }

  /// Checks that the rates conserve the moments of u.
  void check_rates(const moments_type& omega, const State& u, real largest, real size) {
    if (!(largest > real(0))) return;
    flow_ = u;
    using size_type = decltype(u.size());
    for (size_type i = 0; i < u.size(); ++i) flow_[i] += (rates_[i] / largest) * (work_[i] - u[i]);
    check_moments(
        omega, moments_(flow_), size,
        "the rates do not conserve the moments (w changes by {} of the largest moment); give unknowns "
        "that a moment couples the same rate");
  }

  /// Checks the moments if ω is a number or a range of numbers; any other type is not checked. In the message
  /// the relative defect replaces {}.
  template <class Omega>
  static void check_moments(const Omega& omega, const Omega& kept, real size, const char* message) {
    if constexpr (std::is_convertible_v<Omega, real>) {
      require_kept(std::abs(static_cast<real>(kept) - static_cast<real>(omega)),
                   std::abs(static_cast<real>(omega)), size, message);
    } else if constexpr (requires {
                           { *std::begin(omega) } -> std::convertible_to<real>;
                           std::end(omega);
                         }) {
      real defect(0), largest(0);
      auto other = std::begin(kept);
      for (const auto& one : omega) {
        if (other == std::end(kept)) break;
        defect = std::max(defect, std::abs(real(*other) - real(one)));
        largest = std::max(largest, std::abs(real(one)));
        ++other;
      }
      require_kept(defect, largest, size, message);
    }
  }

  /// Rounding errors of sums over N numbers stay far below 1e-8 of ω or, where ω cancels, 1e-12 of `size` =
  /// Σ|E|. Errors of a wrong formula for E do not.
  static void require_kept(real defect, real largest, real size, const char* message) {
    if (defect <= real(1e-8) * largest || defect <= real(1e-12) * size || !(largest > real(0))) return;
    char part[32];
    std::snprintf(part, sizeof part, "%.2g", static_cast<double>(defect / largest));
    std::string text = message;
    throw input_error(text.replace(text.find("{}"), 2, part));
  }

  Transport transport_;
  Moments moments_;
  Equilibrium equilibrium_;
  Rate rate_;
  real epsilon_;
  std::function<real(real, const State&)> forward_euler_;
  std::function<bool(const State&)> admissible_;
  State work_{}, flow_{},  ///< E, Q or T; T + Q
      rates_{};            ///< C of each unknown
  int unchecked_ = 2;      ///< number of evaluations of E still to be checked
};

/// @cond
template <class Transport, class Moments, class Equilibrium, class Rate>
relaxation_problem(Transport, Moments, Equilibrium, Rate, double)
    -> relaxation_problem<Transport, Moments, Equilibrium, Rate>;
/// @endcond

/// Makes a relaxation_problem with a state other than std::vector<double>; throws like the constructor.
template <array_state State, class Transport, class Moments, class Equilibrium, class Rate>
auto make_relaxation_problem(Transport transport, Moments moments, Equilibrium equilibrium, Rate rate,
                             state_real<State> epsilon) {
  return relaxation_problem<Transport, Moments, Equilibrium, Rate, State>(
      std::move(transport), std::move(moments), std::move(equilibrium), std::move(rate), epsilon);
}

}  // namespace apsis
