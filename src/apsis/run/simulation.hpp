#pragma once

#include <apsis/config/case.hpp>
#include <apsis/phase/velocity_set.hpp>
#include <apsis/run/run_state.hpp>

#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace apsis {

/// What a run promises because its configuration entails it. A broken promise ends the run (exit code 3).
struct run_promises {
  bool positivity = false;    ///< nonnegative data, limiter (or first-order upwind), Δt ≤ r Δt_FE
  bool conservation = false;  ///< there are invariants, no open ends, and Q is implicit or Δt ≤ r Δt_FE
  bool entropy = false;       ///< the same with first-order upwind and a periodic boundary
  std::string text() const;   ///< one line for the log
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
  const velocity_set& velocities() const;  ///< of the components; none without space
  std::vector<double> epsilon() const;     ///< at the cell centres

  /// Everything that a restart needs to go on to the same last digit.
  run_state save() const;
  /// Continues from where `saved` was taken; the case must be the same. Throws input_error if the sizes
  /// differ.
  void restore(const run_state& saved);
  const step_record& initial_record() const;  ///< of the initial state

 private:
  struct impl;
  std::unique_ptr<impl> impl_;
};

}  // namespace apsis
