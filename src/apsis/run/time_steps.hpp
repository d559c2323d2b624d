#pragma once

#include <apsis/integrate/any_stepper.hpp>
#include <apsis/integrate/error_control.hpp>
#include <apsis/integrate/tolerance_forecast.hpp>
#include <apsis/run/loss_watch.hpp>
#include <apsis/run/progression.hpp>
#include <apsis/run/stability_watch.hpp>

#include <cstddef>
#include <memory>
#include <optional>

namespace apsis {

/// Steps in time by the method of the case; the step rule gives their length. Promises are decided before the
/// first step and checked after every step.
class time_steps final : public progression {
 public:
  /// Makes the stepper, and limits the problem for steps of the case. `run` must outlive the object.
  explicit time_steps(running_case& run);

  void start() override;
  void advance() override;
  void check() override;
  bool finished() const override;
  double next_dt() override { return run_.march.next(proposed()); }
  long steps_left() override;
  bool next_step_depends_on_end() override;
  std::size_t stages_of_step() const override { return run_.setup.stages_of_step(); }
  long rejected_steps() const override { return control_ ? control_->rejected() : 0; }
  double limiter_share() const override { return limiter_share_; }
  double expected_loss() const override { return losses_.expected(); }
  double expected_plateau() const override { return expected_ ? expected_->error : 0.0; }
  void save(run_state& saved) const override;
  void restore(const run_state& saved) override;

 private:
  auto distance();
  void limit_for_steps();
  void warn_before_steps(double relaxation);
  void start_steps(double relaxation);
  void warn_of_tolerance(double longest, double relaxation);
  void start_watch();
  double forward_euler_limit();
  double limit();
  double proposed();
  double step();
  void begin_budget();
  void record(double dt);

  running_case& run_;
  budgeted_problem budgeted_;  ///< the problem with the budget of its surfaces
  std::unique_ptr<any_stepper<budgeted_problem>> integrator_;
  stability_watch stability_;
  field before_;  ///< state before a step; empty without time.steady
  std::optional<step_controller<double>> control_;
  std::optional<error_estimate<budgeted_problem>> estimate_;  ///< only with a tolerance
  std::optional<tolerance_forecast<double>> expected_;
  loss_watch losses_;
  double limiter_share_ = 1.0;  ///< simulation::limiter_share()
};

}  // namespace apsis
