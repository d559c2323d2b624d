#pragma once

#include "contest.hpp"

#include <apsis/run/setup.hpp>

#include <memory>
#include <string>
#include <vector>

namespace apsis::bench::peers {

/// Monitors a run between its steps: smallest values, and the time of the steps alone.
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

/// Unknowns of the discretization in space.
enum class unknowns {
  averages,  ///< cell averages, finite volumes: the collision is evaluated at Gauss points (paper/bgk-mixed)
  points     ///< point values, finite differences: the collision is pointwise (paper/bgk-mixed-fd)
};

/// The mixed-regime problem of the paper on its mesh as a system of ordinary differential equations f' = T(f)
/// + Q(f)/ε, with the same functions for all integrators.
class mixed_regime {
 public:
  mixed_regime(double end, unknowns which);

  double end() const { return end_; }
  const field& initial() const { return initial_; }
  semidiscrete_problem& problem() { return *problem_; }
  const relaxation_model& equation() const;
  /// Returns 1/ε of every cell: at its centre, or the mean over its Gauss points.
  const std::vector<double>& rates() const { return rates_; }
  /// Returns the number of steps of `m` in [0, end] at the largest Δt for which f stays nonnegative, r Δt_FE.
  long positive_steps(const method& m) const;

  /// Runs `steps` equal steps of a method; `graded`: the first of them divided into steps that resolve
  /// the initial layer.
  outcome run(const method& m, long steps, bool graded, double seconds_allowed, field* result = nullptr);
  /// Runs a method with an embedded solution to a tolerance of the steps, relative to f in the 2-norm.
  outcome run_to_tolerance(const method& m, double tolerance, double seconds_allowed);

  void set_reference(field exact) { reference_ = std::move(exact); }
  double error(const field& u) const { return distance(u, reference_); }
  static double distance(const field& u, const field& exact);

 private:
  /// Measures run(u, observer), an integration of u from the initial state.
  template <class Run>
  outcome measure(double seconds_allowed, field* result, const Run& run);

  case_config config_;
  double end_;
  run_setup setup_;
  std::unique_ptr<semidiscrete_problem> problem_;
  field initial_, reference_;
  std::vector<double> rates_;
};

}  // namespace apsis::bench::peers
