#pragma once

#include <apsis/study/compare.hpp>
#include <apsis/study/vary.hpp>

#include <memory>
#include <string>
#include <vector>

namespace apsis {

/// Definition of a study: a case, the grid of all combinations of the varied keys, and the measure of errors.
/// It does not depend on the model: any key of any case can be varied.
struct convergence_study {
  std::string case_name;  ///< a case file or a built-in case
  std::string case_text =
      {};  ///< text of a case that is not a file (to_toml(config)); empty: the case named case_name
  std::vector<std::string> overrides = {};  ///< "key=value", for every run
  std::vector<varied_key> vary = {};        ///< the last key varies fastest
  convergence_reference reference = {};     ///< what errors are measured against
  error_norm norm = error_norm::l2;         ///< norm of the difference to the reference
  std::string quantity = {};                ///< a macroscopic field; empty: the full state
};

/// One run and its error.
struct convergence_row {
  std::vector<std::string> values;  ///< values of the varied keys as given, in the order of the study
  case_config config;               ///< resolved case
  double h = 0.0;                   ///< denominator of the rate: Δx, Δt, Δv, or the value of the key
  double error = 0.0;  ///< norm of the difference from the reference; NaN without one, see `problem`
  double rate = 0.0;   ///< log(error before/error) / log(h before/h); NaN in the first row and without errors
  long steps = 0;      ///< steps done
  double dt = 0.0,     ///< longest step
      min_value = 0.0;  ///< smallest unknown of all steps; NaN if the run failed
  double wall_s = 0.0,  ///< wall time of the steps in seconds; every run is on one thread
      cpu_s = 0.0;      ///< CPU time of the steps in seconds
  std::string problem;  ///< reason for a missing error: the failure and its place
};

/// The runs with equal values of all keys except the refined one, from coarse to fine.
struct convergence_block {
  std::vector<std::string> values;    ///< values of the other keys, in the order of the study
  std::string title;                  ///< "time.method = md-imex-3-2, model.epsilon = 1"
  std::vector<convergence_row> rows;  ///< rows of runs that were computed or failed
};

/// Result of a study. Everything is dimensionless except times in seconds.
struct convergence_table {
  std::string title;              ///< of the case
  std::vector<std::string> keys;  ///< varied keys in the order of the study
  int refined = -1;               ///< index into `keys`; −1 without a refined key (then there are no rates)
  std::string h_name;             ///< "Δx", "Δt", "Δv" or the name of the refined key
  std::string measure;            ///< "l2 norm of the difference to the next finer run"
  std::string measured;           ///< "error", or "difference" if the next finer run is the reference
  std::vector<convergence_block> blocks;  ///< blocks with rows
  long runs = 0;                          ///< number of different runs, including references
  bool complete = true;                   ///< whether every run was computed or failed

  long failures() const;  ///< number of rows without an error
};

/// A study in three steps: the constructor plans it, run() computes it, and table() returns the results, also
/// those of a stopped study. Identical runs, including references, are computed once.
///
/// The refined key is the last varied one of space.cells, time.dt, time.cfl, time.safety and velocity.points.
/// If none of them is varied, it is the last key with positive numbers as values, such as model.epsilon. The
/// rate then refers to this number.
class convergence {
 public:
  static constexpr long most_runs = 10'000;  ///< largest number of combinations of values in a study

  /// Resolves every run and every reference and validates them before the first step. Throws input_error or
  /// io_error for unknown or repeated keys, a repeated value, or too many runs. Also throws for a reference
  /// that does not exist or cannot be compared.
  explicit convergence(convergence_study study);
  ~convergence();
  convergence(convergence&&) noexcept;             ///< leaves the source empty
  convergence& operator=(convergence&&) noexcept;  ///< leaves the source empty

  /// Computes missing runs on all threads (see set_threads), the longest first. Results do not depend
  /// on the number of threads. A run that fails numerically is noted in its row, and the study
  /// continues. On a stop request, throws study_interrupted after the current steps; finished runs are
  /// kept, active ones are dropped.
  void run(const study_control& control = {});

  /// Returns the number of runs that were computed or failed, including references.
  long finished_runs() const;

  /// Returns the rows of all runs that are finished.
  convergence_table table() const;

 private:
  struct impl;
  std::unique_ptr<impl> impl_;
};

/// Plans, runs and tabulates a study.
convergence_table converge(const convergence_study& study, const study_control& control = {});

}  // namespace apsis
