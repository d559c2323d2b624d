#pragma once

#include <apsis/verify/convergence.hpp>

#include <string>
#include <vector>

namespace apsis {

/// What a study will compute, before anything is computed.
struct convergence_plan {
  /// A run and what it is compared with.
  struct row {
    std::vector<std::string> values;  ///< of the varied keys
    std::size_t run;                  ///< index into `runs`
    long reference;                   ///< likewise; −1 is the exact solution
    double h;                         ///< what is refined; of time keys only until the step is known
  };
  /// Runs that differ in the refined key alone; all runs where there is none.
  struct block {
    std::vector<std::string> values;  ///< of the other keys
    std::string title;                ///< "time.method = md-imex-3-2, model.epsilon = 1"
    std::vector<row> rows;            ///< from coarse to fine
  };

  std::string title,              ///< of the case
      h_name,                     ///< "Δx", "Δt", "Δv" or the name of the refined key
      measure,                    ///< "l2 norm of the difference to the next finer run"
      measured;                   ///< "error", or "difference" where the next finer run is the reference
  std::vector<std::string> keys;  ///< varied keys in the order of the study
  int refined = -1;               ///< index into `keys`; −1 where nothing is refined
  bool refined_in_time = false;   ///< then h is the step that was taken
  std::vector<case_config> runs;  ///< all different
  std::vector<double> work;       ///< estimated, for the order in which they are computed
  std::vector<block> blocks;      ///< in the order of the grid
};

/// Throws input_error and io_error, see class convergence.
convergence_plan make_plan(const convergence_study& study);

}  // namespace apsis
