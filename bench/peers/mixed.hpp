#pragma once

#include "contest.hpp"

#include <apsis/run/setup.hpp>

#include <string>
#include <vector>

namespace apsis::bench::peers {

/// Watches a run between its steps: smallest values, and the time of the steps alone.
class watch {
 public:
  explicit watch(double seconds_allowed) : allowed_(seconds_allowed) {}
  void start();
  /// After a step; false if the time that is allowed is over.
  bool stepped(const field& u);
  /// What was seen; `u` is the state at the end.
  outcome seen(const field& u) const;

 private:
  double allowed_, begin_ = 0.0, seconds_ = 0.0, smallest_;
  long steps_ = 0;
};

/// The mixed-regime problem of the paper on its mesh: a system of ordinary differential equations f' = T(f) +
/// Q(f)/ε, the same functions for all who integrate it.
class mixed_regime {
 public:
  explicit mixed_regime(double end);

  double end() const { return end_; }
  const field& initial() const { return initial_; }
  semidiscrete_problem& problem() { return *problem_; }
  const relaxation_model& equation() const;
  /// Mean of 1/ε over the Gauss points of every cell.
  const std::vector<double>& rates() const { return rates_; }
  /// Steps of `m` in [0, end] at the largest Δt for which f stays nonnegative, r Δt_FE.
  long positive_steps(const method& m) const;

  /// `steps` equal steps of a method; `graded`: the first of them cut into steps that resolve the initial
  /// layer.
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
