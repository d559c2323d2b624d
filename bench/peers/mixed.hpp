#pragma once

#include "contest.hpp"

#include <apsis/run/setup.hpp>

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

/// The mixed-regime problem of the paper on its mesh as a system of ordinary differential equations f' = T(f)
/// + Q(f)/ε, with the same functions for all integrators.
class mixed_regime {
 public:
  explicit mixed_regime(double end);

  double end() const { return end_; }
  const field& initial() const { return initial_; }
  semidiscrete_problem& problem() { return *problem_; }
  const relaxation_model& equation() const;
  /// Returns the mean of 1/ε over the Gauss points of every cell.
  const std::vector<double>& rates() const { return rates_; }
  /// Returns the number of steps of `m` in [0, end] at the largest Δt for which f stays nonnegative, r Δt_FE.
  long positive_steps(const method& m) const;

  /// Runs `steps` equal steps of a method; `graded`: the first of them divided into steps that resolve
  /// the initial layer.
  outcome run(const method& m, long steps, bool graded, double seconds_allowed, field* result = nullptr);

  void set_reference(field exact) { reference_ = std::move(exact); }
  double error(const field& u) const { return distance(u, reference_); }
  static double distance(const field& u, const field& exact);

 private:
  case_config config_;
  double end_;
  run_setup setup_;
  std::unique_ptr<semidiscrete_problem> problem_;
  field initial_, reference_;
  std::vector<double> rates_;
};

}  // namespace apsis::bench::peers
