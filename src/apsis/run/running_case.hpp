#pragma once

#include <apsis/exec/communicator.hpp>
#include <apsis/integrate/integrate.hpp>
#include <apsis/mesh/field.hpp>
#include <apsis/run/flow_watch.hpp>
#include <apsis/run/monitor.hpp>
#include <apsis/run/rounding.hpp>
#include <apsis/run/run_promises.hpp>
#include <apsis/run/run_state.hpp>
#include <apsis/run/setup.hpp>
#include <apsis/run/simulation.hpp>
#include <apsis/run/wall_temperatures.hpp>
#include <apsis/semidiscrete/budgeted_problem.hpp>

#include <memory>
#include <vector>

namespace apsis {

/// The parts of every run of a case, in steps of time or in iterations.
struct running_case {
  /// Makes the problem and the state. The state is that of `start`, or without it the
  /// initial data of the case.
  running_case(std::unique_ptr<run_setup> prepared, const state_source& start);
  running_case(const running_case&) = delete;
  running_case& operator=(const running_case&) = delete;

  /// Sets the records of the initial state.
  void start_records();
  /// Enters the number of the step and the time after a step dt into the records.
  void record_position(double dt);
  /// Returns the error with the number of the step and the time before the step.
  numerical_error located(const numerical_error& failure) const;

  std::unique_ptr<run_setup> made;                ///< owner of `setup`
  const run_setup& setup;                         ///< the objects of the case
  const case_config& config;                      ///< the case as given
  std::unique_ptr<semidiscrete_problem> problem;  ///< T and Q
  monitor watch;                                  ///< checks every step
  flow_watch flows;                               ///< warns about flows in its stages
  wall_temperatures walls;                        ///< computes temperatures after every step
  rounding_bound rounding;                        ///< bound for the sums of a step
  budgeted_state now;                             ///< the state, and the budget of the present step
  field& state = now.unknowns;                    ///< unknowns of `now`
  std::vector<double> budget;                     ///< budget of the last step
  time_marcher<double> march;                     ///< position in time
  run_promises promises;                          ///< checked after every step
  step_record first,                              ///< record of the initial state
      last;                                       ///< record of the last step
  run_summary totals;                             ///< totals of all steps so far
};

/// Returns the setup of a case. Throws input_error if its state and buffers do not fit into memory.
std::unique_ptr<run_setup> setup_that_fits(const case_config& config,
                                           const std::shared_ptr<communicator>& processes);

/// Returns the unknowns as [cells][components], contiguous.
std::vector<double> without_padding(const field& u);
/// u ← values, [cells][components].
void copy_rows(const std::vector<double>& values, field& u);

}  // namespace apsis
