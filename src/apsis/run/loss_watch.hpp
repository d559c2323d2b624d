#pragma once

#include <apsis/integrate/rate_loss.hpp>
#include <apsis/run/setup.hpp>

#include <memory>
#include <optional>
#include <string>

namespace apsis {

/// Estimates before and during a run the error of its method in the terms of size ε (rate_loss.hpp,
/// docs/plateaus.md). Warns once, and suggests a better method if there is one. Makes no estimate for
/// implicit-only methods, for models without a relaxation time, or if memory is short.
///
/// The estimate of the relative error at time.end is ∫‖E′ℛT′(E)(flux(z) − 1)D‖ dt, plus the errors of
/// the initial layer and of the deviation from equilibrium. It is an upper estimate at moving fronts,
/// where errors cancel.
class loss_watch {
 public:
  /// `setup` and `problem` must outlive the watch, which solves collisions of `problem`.
  loss_watch(const run_setup& setup, semidiscrete_problem& problem);
  ~loss_watch();

  /// Estimates the loss of a run that starts at t from u with steps dt. `layer` is true if the first step
  /// covers an initial layer that no graded start resolves. Collective.
  void start(double t, const field& u, double dt, bool layer);
  /// Updates the estimate after a step to t if one is due. It is due at least 64 steps after the last one,
  /// once the number of steps or Δt has doubled. Collective.
  void after_step(long step, double t, double dt, const field& u);

  /// Returns the estimate of the relative error at time.end; 0 if nothing was estimated.
  double expected() const { return expected_; }
  /// Returns whether the warning was given.
  bool warned() const { return warned_; }

 private:
  using loss = rate_loss<double>;
  std::optional<loss> estimate(double t, const field& u, double dt, const rate_response& of, bool layer);
  void check(double t, const field& u, double dt, bool layer);
  void warn(double t, const field& u, double dt, bool layer, const loss& found);
  std::string remedy(double t, const field& u, double dt, bool layer);

  const run_setup& setup_;
  semidiscrete_problem& problem_;
  std::unique_ptr<semidiscrete_problem> implicit_;  ///< for estimates, if collisions of problem_ are exact
  std::optional<rate_response> response_;
  double done_ = 0.0,       ///< estimated error of the moments until t_
      rate_ = 0.0,          ///< estimated error per unit of time after t_
      t_ = 0.0, dt_ = 0.0,  ///< at the last estimate
      expected_ = 0.0;
  long step_ = 0;  ///< number of steps at the last estimate
  bool warned_ = false;
};

}  // namespace apsis
