#pragma once

#include <apsis/study/convergence.hpp>

#include <string>
#include <vector>

namespace apsis {

/// What a study will compute, before anything is computed.
struct convergence_plan {
  struct row {
    std::vector<std::string> values;  ///< of the varied keys
    std::size_t run;                  ///< index into `runs`
    long reference;                   ///< likewise; −1 is the exact solution
    double h;                         ///< what is refined; of time keys only until the step is known
  };
  struct block {
    std::vector<std::string> values;
    std::string title;
    std::vector<row> rows;
  };

  std::string title, h_name, measure;
  std::vector<std::string> keys;
  int refined = -1;
  bool refined_in_time = false;   ///< then h is the step that was taken
  std::vector<case_config> runs;  ///< all different
  std::vector<double> work;       ///< estimated, for the order in which they are computed
  std::vector<block> blocks;
};

/// Throws input_error and io_error, see class convergence.
convergence_plan make_plan(const convergence_study& study);

}  // namespace apsis
