#pragma once

#include <apsis/study/convergence.hpp>

#include <string>
#include <vector>

namespace apsis {

/// Plan of a study: its runs, blocks and references.
struct convergence_plan {
  /// A run and its reference.
  struct row {
    std::vector<std::string> values;  ///< values of the varied keys
    std::size_t run;                  ///< index into `runs`
    long reference;                   ///< index of the reference; −1 is the exact solution
    double h;                         ///< h of the rate; for time keys set when the step is known
  };
  /// Runs that differ only in the refined key; without a refined key, all runs.
  struct block {
    std::vector<std::string> values;  ///< values of the other keys
    std::string title;                ///< "time.method = md-imex-3-2, model.epsilon = 1"
    std::vector<row> rows;            ///< from coarse to fine
  };

  std::string title,              ///< of the case
      h_name,                     ///< "Δx", "Δt", "Δv" or the name of the refined key
      measure,                    ///< "l2 norm of the difference to the next finer run"
      measured;                   ///< "error", or "difference" if the next finer run is the reference
  std::vector<std::string> keys;  ///< varied keys in the order of the study
  int refined = -1;               ///< index into `keys`; −1 without a refined key
  bool refined_in_time = false;   ///< whether h is the actual step
  std::vector<case_config> runs;  ///< all different
  std::vector<double> work;       ///< estimated cost, which orders the runs
  std::vector<block> blocks;      ///< in the order of the grid
};

/// Returns the plan of a study. Throws input_error and io_error, see class convergence.
convergence_plan make_plan(const convergence_study& study);

}  // namespace apsis
