#pragma once

#include "collision_inverse.hpp"
#include "contest.hpp"

#include <apsis/run/setup.hpp>

#include <memory>
#include <string>
#include <vector>

namespace apsis::bench::peers {

/// Monitors a run between its steps: smallest values, and the time of the steps without the monitoring.
class run_monitor {
 public:
  explicit run_monitor(double seconds_allowed) : allowed_(seconds_allowed) {}
  void start();
  /// To be called after each step; returns false once the time limit is exceeded.
  bool stepped(const field& u);
  /// Returns the measurements; `u` is the state at the end.
  outcome result(const field& u) const;

 private:
  double allowed_, begin_ = 0.0, seconds_ = 0.0, smallest_;
  long steps_ = 0;
};

/// A case as a system of ordinary differential equations f' = T(f) + Q(f)/ε on its mesh, from t = 0 to `end`.
/// All integrators use the same functions.
class kinetic_task {
 public:
  /// `overrides`: KEY=VALUE, as on the command line. The model must be a relaxation in one space dimension.
  kinetic_task(const std::string& case_name, std::vector<std::string> overrides, double end);

  double end() const { return end_; }
  const field& initial() const { return initial_; }
  /// Returns the problem for integrators that preserve no signs.
  semidiscrete_problem& problem() { return *smooth_; }
  /// Returns the inverse of I − γJ for the Jacobian J of the collision.
  std::unique_ptr<collision_inverse> inverse() const;
  /// Returns the number of steps of an integrator in [0, end] of the length r Δt_FE, the largest for which f
  /// stays nonnegative. Without a known r, r = 1.
  long positive_steps(const std::string& name) const;

  /// Runs `steps` equal steps of an integrator of integrators.hpp. With `graded` the first of them is divided
  /// into steps that resolve the initial layer.
  outcome run(const std::string& name, long steps, bool graded, double seconds_allowed,
              field* result = nullptr);
  /// Runs a method with an embedded solution to a tolerance of the steps, relative to f in the 2-norm.
  outcome run_to_tolerance(const method& m, double tolerance, double seconds_allowed);
  /// Returns the solution by extrapolated Euler steps of order 8 (integrate/extrapolation.hpp). `tolerance`
  /// bounds the error of a step, relative to f in the 2-norm.
  field extrapolated(double tolerance);

  void set_reference(field exact) { reference_ = std::move(exact); }
  double error(const field& u) const { return distance(u, reference_); }
  static double distance(const field& u, const field& exact);

 private:
  semidiscrete_problem& problem_of(const std::string& integrator) const;
  const relaxation_model& equation() const { return *setup_.equation->as_relaxation(); }
  /// Measures run(u, observer), an integration of u from the initial state.
  template <class Run>
  outcome measure(double seconds_allowed, field* result, const Run& run);

  case_config config_;
  double end_;
  run_setup setup_;
  std::unique_ptr<semidiscrete_problem> problem_,
      smooth_,  ///< for methods that preserve no signs, with the same T and Q
      exact_;   ///< for methods with exact collisions
  field initial_, reference_;
  std::vector<double> rates_;  ///< 1/ε of every cell: at its centre, or the mean over its Gauss points
};

}  // namespace apsis::bench::peers
