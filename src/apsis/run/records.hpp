#pragma once

#include <apsis/output/checkpoint.hpp>
#include <apsis/output/solution.hpp>
#include <apsis/run/simulation.hpp>

namespace apsis {

/// What a run leaves behind besides its state: a row for every step and the snapshots of the fields. The
/// results know tables and not runs, so the translation between the two is here.
class run_records {
 public:
  explicit run_records(const simulation& run);
  /// Goes on with the records of a checkpoint.
  run_records(const simulation& run, const checkpoint& from);

  void add_step(const step_record& record);
  void add_snapshot(const simulation& run);

  const table& history() const { return history_; }
  const field_series& fields() const { return fields_; }

 private:
  void name_columns(const simulation& run);

  table history_;
  field_series fields_;
};

checkpoint make_checkpoint(const simulation& run, const run_records& records);

/// The part of a checkpoint that a simulation goes on from. Throws io_error where something is missing.
saved_run to_saved_run(const checkpoint& c);

/// Of every `stride`-th cell.
distribution_snapshot make_distribution_snapshot(const simulation& run, int stride);

solution make_solution(const simulation& run, const run_records& records);

}  // namespace apsis
