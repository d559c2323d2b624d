#pragma once

#include <apsis/exec/profile.hpp>
#include <apsis/integrate/stepper.hpp>
#include <apsis/run/setup.hpp>

#include <memory>
#include <string>
#include <vector>

namespace apsis::bench {

/// Work of the sweeps of a step.
struct sweep_work {
  double numbers;    ///< numbers of all sweeps
  int accumulators;  ///< accumulators that a sweep changes, rounded mean
  double share;      ///< share of the time of all kernels
};

/// Steps of the mixed-regime problem of the paper (data V, 150 velocities) without monitoring.
class mixed_step {
 public:
  /// `overrides` are additional keys of the case, "key=value".
  mixed_step(const std::string& discretization, const std::string& method, int cells,
             std::vector<std::string> overrides = {});
  /// Steps of another case, on a device unless `on` is null.
  explicit mixed_step(const case_config& config, std::shared_ptr<device> on = nullptr);

  void take(int steps) {
    for (int k = 0; k < steps; ++k) stepper_.step(0.0, dt_, u_);
    if (on_) on_->finish();
  }
  /// Counts the operations and bytes of a step by taking one.
  kernel_work count_work();
  /// Takes a step, counts the numbers of its sweeps, and measures their share of its time.
  sweep_work count_sweeps();
  /// Returns the fraction of values that are subnormal.
  double subnormal_share() const;
  /// Returns the point·stages of a step: N · N_v · s.
  double point_stages() const;
  /// Returns the number of values of a field, including padding.
  std::size_t numbers() const {
    return static_cast<std::size_t>(u_.cells()) * static_cast<std::size_t>(u_.stride());
  }
  /// Returns the number of passes of a step over the field; threads synchronize after each.
  int passes() const;
  /// Returns the number of steps that take about this many seconds.
  int steps_in(double seconds);

 private:
  std::shared_ptr<device> on_;  ///< null: the host
  run_setup setup_;
  std::unique_ptr<semidiscrete_problem> problem_;
  stepper<semidiscrete_problem> stepper_;
  field u_;
  bool fuses_solves_;  ///< with point values, the pass that completes a stage also solves it
  double dt_;
};

}  // namespace apsis::bench
