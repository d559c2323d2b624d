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
  long step = 0;                            ///< number of the step, 0 for the initial state
  double t = 0.0,                           ///< time at its end
      dt = 0.0;                             ///< its length
  double min_value = 0.0;                   ///< smallest unknown of the state
  long negative_values = 0;                 ///< number of unknowns < 0
  std::vector<double> conservation_defect;  ///< per invariant: |I − I₀| / scale of I₀
  double entropy = 0.0;                     ///< NaN where the model has none, or an unknown is < 0
  double entropy_change = 0.0;              ///< S^{n+1} − S^n; NaN where there is no S, and at the start
};

/// What a run promises because its configuration entails it. A broken promise ends the run (exit code 3).
struct run_promises {
  bool positivity = false;    ///< nonnegative data, limiter (or first-order upwind), Δt ≤ r Δt_FE
  bool conservation = false;  ///< there are invariants, no open ends, and Q is implicit or Δt ≤ r Δt_FE
  bool entropy = false;       ///< the same with first-order upwind and a periodic boundary
  std::string text() const;   ///< one line for the log
};

/// Everything about a finished (or interrupted) run.
struct run_summary {
  long steps = 0;            ///< steps done
  long startup_steps = 0;    ///< steps that took the place of the first; 0 without start-up
  long rejected_steps = 0;   ///< whose estimated error was above the tolerance; not among the steps
  double dt = 0.0,           ///< longest step
      t = 0.0,               ///< time reached
      wall_s = 0.0;          ///< wall time of the steps in seconds, those before a restart included
  double cpu_s = 0.0;        ///< CPU time of the calling thread in steps, since the start or the last restart
  double min_value = 0.0;    ///< over all steps, the initial state included
  long negative_values = 0;  ///< sum over all steps
  double conservation_defect = 0.0;   ///< largest of any invariant and step
  double max_entropy_increase = 0.0;  ///< largest entropy_change; 0 if none was positive
  long phase_points = 0;              ///< cells × components
  double point_stages_per_s = 0.0;  ///< phase_points · stages per second of wall time, also of rejected steps
};

/// A run between two steps, for checkpoints.
struct saved_run {
  std::vector<double> state;  ///< [cells][components]
  // See time_marcher::progress.
  long step = 0,                ///< steps done
      since_anchor = 0;         ///< steps since `anchor`
  double t = 0.0,               ///< time
      anchor = 0.0,             ///< t = anchor + since_anchor · anchor_dt
      anchor_dt = 0.0;          ///< length of the steps since `anchor`
  long startup_steps = 0,       ///< in place of the first step; 0 without start-up
      startup_done = 0;         ///< start-up steps done
  double startup_length = 0.0;  ///< length of all start-up steps together
  // See step_controller::progress; as at the start where no tolerance is kept.
  double proposed_dt = std::numeric_limits<double>::infinity(),  ///< longest that the next step should be
      previous_error = 1.0;  ///< estimate over tolerance of the last good step
  bool step_holds = false;   ///< the last attempt was rejected, so the step does not grow
  run_summary so_far;        ///< totals of all steps
  step_record initial,       ///< record of the initial state
      last;                  ///< record of the last step
};

/// Macroscopic fields on the mesh at one time: values[field][cell].
struct field_table {
  std::vector<double> x;                    ///< cell centres; {0} without space
  std::vector<std::string> names,           ///< of the fields: "rho"
      labels;                               ///< for plots: "density (dimensionless)"
  std::vector<std::vector<double>> values;  ///< [field][cell]
};

/// One run of a case. Construction checks everything that can be checked before the first step.
class simulation {
 public:
  /// Throws input_error (for example: v_max too small for the data, mesh smaller than the stencil).
  explicit simulation(case_config config);
  ~simulation();
  simulation(simulation&&) noexcept;             ///< the other one has no run any more
  simulation& operator=(simulation&&) noexcept;  ///< the other one has no run any more

  const case_config& config() const;            ///< the case as it was given
  const run_promises& promises() const;         ///< what is checked after every step
  std::vector<std::string> invariants() const;  ///< names, in the order of conservation_defect
  double t() const;                             ///< time reached
  double dt() const;                            ///< of the next step
  long step() const;                            ///< steps done
  long steps_total() const;                     ///< estimate from the present dt
  bool finished() const;                        ///< t() is time.end
  /// Forecast of the relative error that the terms of size ε leave in a run to time.tolerance; above the
  /// tolerance a warning says so. 0 where the steps resolve the relaxation, or without tolerance.
  double expected_plateau() const;
  /// Number of snapshot times k · output.every, k ≥ 1, up to t(); steps end at each of them exactly.
  long snapshot_times_passed() const;
  /// Whether the next step would be another one if time.end were later: a run that may be continued to a
  /// later end is saved before that step.
  bool next_step_depends_on_end() const;

  /// One step. Throws numerical_error with step, time, cell and value. If a stage failed, the state is that
  /// of the last good step; if a promise was broken, it is the state that broke it, and last() describes it.
  const step_record& advance();
  const step_record& last() const;  ///< of the last step, or of the initial state
  run_summary summary() const;      ///< totals of all steps so far

  field_table fields() const;         ///< macroscopic fields of the present state
  bool has_space() const;             ///< whether the model has a mesh
  int cells() const;                  ///< of the mesh; 1 without space
  int components() const;             ///< unknowns of a cell
  std::vector<double> state() const;  ///< [cells][components], contiguous
  /// The exact solution at t() in the form of state(); empty where no formula is known for the data.
  std::vector<double> exact_state() const;
  std::vector<double> velocities() const;  ///< speeds of the components; empty without space
  std::vector<double> epsilon() const;     ///< at the cell centres

  /// Everything that a restart needs to go on to the same last digit.
  saved_run save() const;
  /// Goes on from where `saved` was taken; the case must be the same. Throws input_error if the sizes differ.
  void restore(const saved_run& saved);
  const step_record& initial_record() const;  ///< of the initial state

 private:
  struct impl;
  std::unique_ptr<impl> impl_;
};

}  // namespace apsis
