#pragma once

#include <apsis/run/run_state.hpp>
#include <apsis/run/running_case.hpp>

#include <cstddef>
#include <memory>

namespace apsis {

/// How a run advances: in steps of time, or in iterations to a steady state. All members that change the run
/// are collective.
class progression {
 public:
  virtual ~progression() = default;

  /// Prepares the first step. running_case::first is the record of the initial state.
  virtual void start() = 0;
  /// Takes one step and enters it into the records of the run. Throws numerical_error with step and time.
  virtual void advance() = 0;
  /// Checks the step that advance() took. Throws numerical_error if it breaks a promise, or if no more steps
  /// are allowed.
  virtual void check() {}

  /// Returns whether advance() itself calls monitor::watch_velocities() and enters its
  /// findings into the totals.
  virtual bool watches_velocities() const { return false; }

  /// Returns whether no step is left or the state is steady.
  virtual bool finished() const = 0;
  virtual double next_dt() = 0;  ///< length of the next step
  /// Returns an estimate of the steps that are left.
  virtual long steps_left() = 0;
  /// Returns whether the next step depends on time.end.
  virtual bool next_step_depends_on_end() = 0;
  /// Returns the number of evaluations of T(u) and of stage solves in a step, for rates of work.
  virtual std::size_t stages_of_step() const = 0;

  virtual long rejected_steps() const { return 0; }        ///< run_summary::rejected_steps
  virtual double limiter_share() const { return 1.0; }     ///< simulation::limiter_share()
  virtual double expected_loss() const { return 0.0; }     ///< simulation::expected_loss()
  virtual double expected_plateau() const { return 0.0; }  ///< simulation::expected_plateau()

  /// Adds to `saved` the data that a restart needs in addition to the state, its records and
  /// its position in time.
  virtual void save(run_state& saved) const = 0;
  /// Restores the data of save(). The state and the position in time are already restored.
  virtual void restore(const run_state& saved) = 0;
};

/// Returns the progression of the case: iterations if it has a table [steady]. `run` must outlive it.
std::unique_ptr<progression> make_progression(running_case& run);

}  // namespace apsis
