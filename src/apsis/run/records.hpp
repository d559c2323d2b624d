#pragma once

#include <apsis/output/checkpoint.hpp>
#include <apsis/output/history.hpp>
#include <apsis/output/solution.hpp>
#include <apsis/run/simulation.hpp>

namespace apsis {

/// What a run leaves behind besides its state: a row for every step and the snapshots of the fields. The
/// results know tables and not runs, so the translation between the two is here.
class run_records {
 public:
  /// Begins with the initial state: a row of the history, and a snapshot if the case wants some.
  explicit run_records(const simulation& run);
  /// Goes on with the records of a checkpoint. Throws io_error if its history has other columns.
  run_records(const simulation& run, const checkpoint& from);

  /// A row of the history.
  void add_step(const step_record& record);
  /// The wanted fields (output.fields) of the present state.
  void add_snapshot(const simulation& run);

  /// Columns step, t, dt, min_value, negative_values, conservation_NAME of every invariant, entropy,
  /// entropy_change; a row for the initial state and every step, at most output.history_rows of them (see
  /// apsis::history).
  const numeric_table& history() const { return history_.rows(); }
  /// Steps from one regular row of the history to the next.
  long history_stride() const { return history_.stride(); }
  /// The snapshots so far.
  const field_series& fields() const { return fields_; }

 private:
  void name_fields(const simulation& run);

  class history history_;
  field_series fields_;
};

/// The case, and what to_run_state() and run_records continue from.
checkpoint make_checkpoint(const simulation& run, const run_records& records);

/// The part of a checkpoint that a simulation continues from. Throws io_error where something is missing.
run_state to_run_state(const checkpoint& c);

/// Of every `stride`-th cell.
distribution_snapshot make_distribution_snapshot(const simulation& run, int stride);

/// All of solution.h5 but the manifest.
solution make_solution(const simulation& run, const run_records& records);

}  // namespace apsis
