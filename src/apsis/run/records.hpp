#pragma once

#include <apsis/output/checkpoint.hpp>
#include <apsis/output/history.hpp>
#include <apsis/output/solution.hpp>
#include <apsis/run/simulation.hpp>

namespace apsis {

/// History and snapshots of a run, as the tables of the results.
class run_records {
 public:
  /// Starts with a history row of the initial state, and a snapshot if the case requests snapshots.
  explicit run_records(const simulation& run);
  /// Continues the records of a checkpoint. Throws io_error if its history has other columns.
  run_records(const simulation& run, const checkpoint& from);

  /// Adds a row to the history.
  void add_step(const step_record& record);
  /// Adds a snapshot of the requested fields (output.fields) of the current state.
  void add_snapshot(const simulation& run);

  /// Returns the history with columns step, t, dt, min_value, negative_values, conservation_NAME of every
  /// invariant, entropy, entropy_change. It has rows for the initial state and for steps, at most
  /// output.history_rows in all (see apsis::history).
  const numeric_table& history() const { return history_.rows(); }
  /// Returns the number of steps between regular rows of the history.
  long history_stride() const { return history_.stride(); }
  /// Returns the snapshots so far.
  const field_series& fields() const { return fields_; }

 private:
  void name_fields(const simulation& run);

  class history history_;
  field_series fields_;
};

/// Returns a checkpoint from which to_run_state() and run_records continue.
checkpoint make_checkpoint(const simulation& run, const run_records& records);

/// Returns the state of a run in a checkpoint. Throws io_error if a number is missing or invalid.
run_state to_run_state(const checkpoint& c);

/// Returns the content of solution.h5 except the manifest.
solution make_solution(const simulation& run, const run_records& records);

}  // namespace apsis
