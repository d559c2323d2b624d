#pragma once

#include <apsis/integrate/rate_loss.hpp>
#include <apsis/run/setup.hpp>

#include <memory>
#include <optional>
#include <string>

namespace apsis {

/// Estimates before and during a run what its method loses of the terms of size ε in its steps
/// (rate_loss.hpp, docs/plateaus.md), and warns once, with a method that does not. Nothing is estimated for
/// implicit-only methods, models without a relaxation time, and where memory for the estimate is short.
///
/// The estimate of the relative error at time.end is ∫‖E′ℛT′(E)(flux(z) − 1)D‖ dt, plus what the initial
/// layer adds, plus the error of the deviation from equilibrium. Where errors cancel, at fronts that move, it
/// is an upper estimate.
class loss_watch {
 public:
  /// `setup` must outlive the watch, and `problem`, whose collisions it solves.
  loss_watch(const run_setup& setup, semidiscrete_problem& problem);
  ~loss_watch();

  /// Estimates the loss of a run that starts at t from u in steps dt; `layer`: whether the first step meets
  /// an initial layer that no graded start resolves. Collective.
  void start(double t, const field& u, double dt, bool layer);
  /// Updates the estimate after a step to t, where an estimate is due: at most one in 64 steps, at doubled
  /// numbers of steps, and where Δt has doubled. Collective.
  void after_step(long step, double t, double dt, const field& u);

  /// Returns the estimate of the relative error at time.end; 0 if nothing was estimated.
  double expected() const { return expected_; }
  /// Whether the warning was given.
  bool warned() const { return warned_; }

 private:
  using loss = rate_loss<double>;
  std::optional<loss> estimate(double t, const field& u, double dt, const rate_response& of, bool layer);
  void check(double t, const field& u, double dt, bool layer);
  void warn(double t, const field& u, double dt, bool layer, const loss& found);
  std::string remedy(double t, const field& u, double dt, bool layer);

  const run_setup& setup_;
  semidiscrete_problem& problem_;
  std::unique_ptr<semidiscrete_problem> implicit_;  ///< where collisions of problem_ are exact
  std::optional<rate_response> response_;
  double done_ = 0.0,       ///< estimated error of the moments until t_
      rate_ = 0.0,          ///< estimated error per unit of time since
      t_ = 0.0, dt_ = 0.0,  ///< at the last estimate
      expected_ = 0.0;
  long step_ = 0;  ///< at the last estimate
  bool warned_ = false;
};

}  // namespace apsis
