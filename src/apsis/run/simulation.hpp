#pragma once

#include <apsis/config/case.hpp>

#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace apsis {

/// What was checked after a step; one row of history.csv. Dimensionless.
struct step_record {
  long step = 0;
  double t = 0.0, dt = 0.0;
  double min_value = 0.0;                   ///< smallest unknown of the state
  long negative_values = 0;                 ///< number of unknowns < 0
  std::vector<double> conservation_defect;  ///< per invariant: |I − I₀| / scale of I₀
  double entropy = 0.0;                     ///< NaN where the model has none
  double entropy_change = 0.0;              ///< S^{n+1} − S^n; NaN where the model has none
};

/// What a run promises because its configuration entails it. A broken promise ends the run (exit code 3).
struct run_promises {
  bool positivity = false;    ///< nonnegative data, limiter (or first-order upwind), Δt ≤ r Δt_FE
  bool conservation = false;  ///< the model has invariants and the boundary is periodic
  bool entropy = false;       ///< the same with first-order upwind and a periodic boundary
  std::string text() const;   ///< one line for the log
};

/// Everything about a finished (or interrupted) run.
struct run_summary {
  long steps = 0;
  long startup_steps = 0;   ///< steps that took the place of the first; 0 without start-up
  long rejected_steps = 0;  ///< whose estimated error was above the tolerance; not among the steps
  double dt = 0.0, t = 0.0, wall_s = 0.0;
  double cpu_s = 0.0;        ///< CPU time of the calling thread in steps, since the start or the last restart
  double min_value = 0.0;    ///< over all steps, the initial state included
  long negative_values = 0;  ///< sum over all steps
  double conservation_defect = 0.0;
  double max_entropy_increase = 0.0;
  long phase_points = 0;
  double point_stages_per_s = 0.0;
  bool interrupted = false;
};

/// A run between two steps, for checkpoints.
struct saved_run {
  std::vector<double> state;  ///< [cells][components]
  long step = 0, since_anchor = 0;
  double t = 0.0, anchor = 0.0, anchor_dt = 0.0;  ///< see time_marcher::progress
  long startup_steps = 0, startup_done = 0;
  double startup_length = 0.0;
  /// See step_controller::progress; as at the start where no tolerance is kept.
  double proposed_dt = std::numeric_limits<double>::infinity(), previous_error = 1.0;
  bool step_holds = false;
  run_summary so_far;
  step_record initial, last;
};

/// Macroscopic fields on the mesh at one time: values[field][cell].
struct field_table {
  std::vector<double> x;
  std::vector<std::string> names, labels;
  std::vector<std::vector<double>> values;
};

/// One run of a case. Construction checks everything that can be checked before the first step.
class simulation {
 public:
  /// Throws input_error (for example: v_max too small for the data, mesh smaller than the stencil).
  explicit simulation(case_config config);
  ~simulation();
  simulation(simulation&&) noexcept;
  simulation& operator=(simulation&&) noexcept;

  const case_config& config() const;
  const run_promises& promises() const;
  std::vector<std::string> invariants() const;
  double t() const;
  double dt() const;         ///< of the next step
  long step() const;         ///< steps done
  long steps_total() const;  ///< estimate from the present dt
  bool finished() const;

  /// One step. Throws numerical_error with step, time, cell and value. If a stage failed, the state is that
  /// of the last good step; if a promise was broken, it is the state that broke it, and last() describes it.
  const step_record& advance();
  const step_record& last() const;  ///< of the last step, or of the initial state
  run_summary summary() const;

  field_table fields() const;
  bool has_space() const;
  int cells() const;
  int components() const;
  std::vector<double> state() const;  ///< [cells][components], contiguous
  /// The exact solution at t() in the form of state(); empty where no formula is known for the data.
  std::vector<double> exact_state() const;
  std::vector<double> velocities() const;  ///< speeds of the components; empty without space
  std::vector<double> epsilon() const;     ///< at the cell centres

  /// Everything that a restart needs to go on to the same last digit.
  saved_run save() const;
  /// Goes on from where `saved` was taken; the case must be the same. Throws input_error if the sizes differ.
  void restore(const saved_run& saved);
  const step_record& initial_record() const;

 private:
  struct impl;
  std::unique_ptr<impl> impl_;
};

}  // namespace apsis
