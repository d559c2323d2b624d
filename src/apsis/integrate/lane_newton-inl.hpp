#pragma once

#include <apsis/core/errors.hpp>
#include <apsis/integrate/array_state.hpp>
#include <apsis/integrate/error_control.hpp>
#include <apsis/integrate/lane_matrix.hpp>
#include <apsis/integrate/lane_system.hpp>
#include <apsis/method/method.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <vector>

/// @cond
namespace apsis::ensemble_parts {

/// The problem of a stepper whose state are eight systems: unknown i of lane k is number 8 i + k.
template <class System>
class newton_lanes {
 public:
  using state = std::vector<double>;
  using real = double;
  using unknowns = typename System::unknowns;
  static constexpr std::size_t size = std::tuple_size_v<unknowns>;

  explicit newton_lanes(System& system) : system_(system) {}

  void add_transport(double t, const state& u, std::span<const target<state, double>> targets) {
    accumulate<state>(targets, u, [&]() -> const state& { return in_work(system_.transport(t, read(u))); });
  }
  void add_collision(double t, const state& u, std::span<const target<state, double>> targets) {
    accumulate<state>(targets, u, [&]() -> const state& { return in_work(system_.collision(t, read(u))); });
  }
  bool has_transport(double t, const state& u) { return !is_zero(in_work(system_.transport(t, read(u)))); }
  double forward_euler_step(double, const state&) const { return std::numeric_limits<double>::infinity(); }

  /// Solves a stage by Newton's method. The matrix of an earlier iteration is kept while corrections shrink
  /// eightfold. The iteration ends with a correction of at most a thousandth of the tolerance, because
  /// extrapolation multiplies errors of solves by up to 300.
  void solve_collision(double t, double a, double, state& u) {
    if (a == 0.0) return;
    ++system_.counts.solves;
    const unknowns explicit_part = read(u);
    unknowns v = explicit_part;
    bool renew = true;
    double before = std::numeric_limits<double>::infinity();
    for (int iteration = 0; iteration < most_iterations; ++iteration) {
      ++system_.counts.iterations;
      unknowns rate = renew ? renew_matrix(t, a, v) : system_.collision(t, v);
      for (std::size_t i = 0; i < size; ++i) rate[i] = (explicit_part[i] - v[i]) + lanes(a) * rate[i];
      matrix_.solve(rate);
      for (std::size_t i = 0; i < size; ++i) v[i] += rate[i];
      const double change = system_.in_tolerances(rate, v, v).of_all();
      if (change <= 1e-3) return write(v, u);
      if (!(change < std::numeric_limits<double>::infinity())) throw_not_finite(v);
      renew = change > before / 8.0;
      before = change;
    }
    throw numerical_error(
        "Newton's method does not solve a stage (the step is too long for the curvature of the collision); "
        "reduce the step");
  }

  /// Returns the largest difference of two states in units of the tolerances.
  double distance(const state& u, const state& v) const {
    const unknowns x = read(u), y = read(v);
    unknowns difference;
    for (std::size_t i = 0; i < size; ++i) difference[i] = x[i] - y[i];
    return system_.in_tolerances(difference, x, y).of_all();
  }

  static unknowns read(const state& u) {
    unknowns v;
    for (std::size_t i = 0; i < size; ++i) v[i] = lanes::load(&u[i * lanes::count]);
    return v;
  }
  static void write(const unknowns& v, state& u) {
    u.resize(size * lanes::count);
    for (std::size_t i = 0; i < size; ++i) v[i].store(&u[i * lanes::count]);
  }

 private:
  static constexpr int most_iterations = 50;

  const state& in_work(const unknowns& v) {
    write(v, work_);
    return work_;
  }

  /// Returns G(t, v), and sets the factors of I − a G'.
  unknowns renew_matrix(double t, double a, const unknowns& v) {
    typename System::matrix jacobian;
    const unknowns rate = system_.collision(t, v, jacobian);
    matrix_.factorize_shifted(a, jacobian);
    return rate;
  }

  [[noreturn]] static void throw_not_finite(const unknowns& v) {
    for (std::size_t k = 0; k < lanes::count; ++k)
      for (std::size_t i = 0; i < size; ++i)
        if (!std::isfinite(v[i][k]))
          throw numerical_error(
              "a stage is not finite (its matrix is singular, or the collision is not); "
              "reduce the step, or check the data",
              {-1, std::numeric_limits<double>::quiet_NaN(), static_cast<long>(k), v[i][k]});
    throw numerical_error("a correction of a stage is not finite (its matrix is singular); reduce the step");
  }

  System& system_;
  lane_matrix<size> matrix_;
  state work_;
};

inline void require_ensemble_method(const method& m) {
  const auto form = m.coefficients<double>();
  const bool second = std::any_of(form.ddot.begin(), form.ddot.end(), [](double x) { return x != 0.0; });
  if (second || solves_exactly(m.kind))
    throw input_error(
        "method '" + m.name +
        "' has second derivatives or exact collisions (stages in lanes have neither); choose one "
        "without, such as extrapolated-euler-5 or ark-436");
}

/// Integrates groups by the steps of a method, with stages solved by Newton's method.
template <class System>
class newton_steps {
 public:
  newton_steps(const method& m, System& system)
      : problem_(system), march_(m, problem_, solutions::result_and_embedded), order_(estimate_of(m).order) {}
  newton_steps(const newton_steps&) = delete;
  newton_steps& operator=(const newton_steps&) = delete;

  void operator()(System& system, typename System::unknowns& u, double t0, double t1) {
    problem_.write(u, state_);
    step_controller<double> control(1.0, order_);
    const auto distance = [this](const auto& x, const auto& y) { return problem_.distance(x, y); };
    system.counts.steps +=
        integrate_to_tolerance(march_, state_, t0, t1, step_rule<double>::unlimited(), control, distance)
            .steps;
    system.counts.rejected += control.rejected();
    u = problem_.read(state_);
  }

 private:
  newton_lanes<System> problem_;
  stepper<newton_lanes<System>> march_;
  int order_;
  std::vector<double> state_;
};

}  // namespace apsis::ensemble_parts
/// @endcond
