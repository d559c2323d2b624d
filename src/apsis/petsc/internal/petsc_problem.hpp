#pragma once

#include "split_functions.hpp"
#include "stage_solver.hpp"
#include "vector.hpp"

#include <apsis/integrate/problem.hpp>

#include <limits>
#include <span>

namespace apsis::petsc {

/// Thrown when a stage fails. The TS then has a new step length, or the reason why it ends.
class rejected_stage : public numerical_error {
 public:
  using numerical_error::numerical_error;
};

/// The equation of a TS as a `problem`.
class petsc_problem {
 public:
  using state = vector;
  using real = double;
  using targets = std::span<const target<state, double>>;

  /// Stores references.
  petsc_problem(split_functions& of, stage_solver& stages) : of_(of), stages_(stages) {}

  /// Sets the length of the step in progress. If `of_ts`, it is a step of the TS, otherwise one of dense
  /// output.
  void begin_step(double dt, bool of_ts) {
    dt_ = dt;
    of_ts_ = of_ts;
  }
  /// Releases the work vectors.
  void reset() {
    rate_.reset();
    more_.reset();
  }
  void add_transport(double t, const state& u, targets to);
  void add_collision(double t, const state& u, targets to);
  void add_transport_and_collision(double t, const state& u, targets to);
  void solve_collision(double t, double a, double b, state& u) { solve({t, a, b, dt_, false}, u); }
  void solve_timed_collision(double t, double a, double b, state& u) { solve({t, a, b, dt_, true}, u); }
  double forward_euler_step(double, const state&) const { return std::numeric_limits<double>::infinity(); }
  bool has_transport(double, const state&) const { return of_.has_transport(); }

 private:
  void solve(const stage& now, state& u);
  /// For each target: acc ← (fresh ? 0 : acc) + α u + β rate(). rate() is called once, if some β ≠ 0.
  template <class Rate>
  void add(const state& u, targets to, const Rate& rate);

  split_functions& of_;
  stage_solver& stages_;
  vector rate_, more_;
  double dt_ = 0.0;
  bool of_ts_ = true;
};

}  // namespace apsis::petsc
