#pragma once

#include <apsis/verify/compare.hpp>
#include <apsis/verify/vary.hpp>

#include <memory>
#include <string>
#include <vector>

namespace apsis {

/// What is to be computed: a case, on the grid of all combinations of the varied keys, and how errors are
/// measured. Nothing here knows a model: any case can be varied in any of its keys.
struct convergence_study {
  std::string case_name;       ///< a case file or a built-in case
  std::string case_text = {};  ///< of a case that is no file (to_toml(config)); empty: that of case_name
  std::vector<std::string> overrides = {};  ///< "key=value", for every run
  std::vector<varied_key> vary = {};        ///< the last one runs fastest
  convergence_reference reference = {};     ///< what errors are measured against
  error_norm norm = error_norm::l2;         ///< norm of the difference to it
  std::string quantity = {};                ///< a macroscopic field; empty: the full state
};

/// One run and its error.
struct convergence_row {
  std::vector<std::string> values;  ///< of the varied keys as given, in the order of the study
  case_config config;               ///< as resolved
  double h = 0.0;                   ///< what the rate is taken against: Δx, Δt, Δv, or the value of the key
  double error = 0.0;  ///< norm of the difference to the reference; NaN if there is none, see `problem`
  double rate = 0.0;   ///< log(error before/error) / log(h before/h); NaN in the first row and without errors
  long steps = 0;      ///< steps done
  double dt = 0.0,     ///< longest step
      min_value = 0.0;  ///< smallest unknown of all steps; NaN if the run failed
  double wall_s = 0.0,  ///< wall time of the steps in seconds; every run is on one thread
      cpu_s = 0.0;      ///< CPU time of the steps in seconds
  std::string problem;  ///< why there is no error: what failed, and where
};

/// The runs with the same values of all keys but the refined one, from coarse to fine.
struct convergence_block {
  std::vector<std::string> values;    ///< of the other keys, in the order of the study
  std::string title;                  ///< "time.method = md-imex-3-2, model.epsilon = 1"
  std::vector<convergence_row> rows;  ///< those that were computed, or failed
};

/// The result of a study. Everything is dimensionless except wall times in seconds.
struct convergence_table {
  std::string title;              ///< of the case
  std::vector<std::string> keys;  ///< varied keys in the order of the study
  int refined = -1;      ///< index into `keys`; −1 where nothing is refined (then there are no rates)
  std::string h_name;    ///< "Δx", "Δt", "Δv" or the name of the refined key
  std::string measure;   ///< "l2 norm of the difference to the next finer run"
  std::string measured;  ///< "error", or "difference" where the next finer run is the reference
  std::vector<convergence_block> blocks;  ///< those that have rows
  long runs = 0;                          ///< different runs that were needed, references included
  bool complete = true;                   ///< every run was computed, or failed

  long failures() const;  ///< rows without an error
};

/// A study in three steps: plan (the constructor), run, and look at the table, also at that of a study that
/// was stopped.
///
/// The refined key is the last varied one of space.cells, time.dt, time.cfl, time.safety and velocity.points;
/// where none of them is varied, the last one whose values are positive numbers (the slope is then against
/// that number, for example against model.epsilon).
/// Runs that are the same, references among them, are computed once.
class convergence {
 public:
  static constexpr long most_runs = 10'000;  ///< combinations of values that a study may have

  /// Resolves every run and every reference and checks what can be checked before a first step. Throws
  /// input_error or io_error: unknown or repeated keys, a value twice, too many runs, a reference that does
  /// not exist or cannot be compared.
  explicit convergence(convergence_study study);
  ~convergence();
  convergence(convergence&&) noexcept;             ///< the other one has no study any more
  convergence& operator=(convergence&&) noexcept;  ///< the other one has no study any more

  /// Computes what is missing, on all threads (see set_threads), the longest runs first; what comes out does
  /// not depend on their number. A run that fails numerically is noted in its row, and the study goes on.
  /// Throws study_interrupted when asked to stop, after the steps under way: runs that are finished are kept,
  /// those under way are dropped.
  void run(const study_control& control = {});

  /// Runs that were computed, or failed, references included.
  long finished_runs() const;

  /// The rows of the runs that are done so far.
  convergence_table table() const;

 private:
  struct impl;
  std::unique_ptr<impl> impl_;
};

/// All three steps.
convergence_table converge(const convergence_study& study, const study_control& control = {});

}  // namespace apsis
