#pragma once

#include <apsis/config/case.hpp>
#include <apsis/exec/aligned.hpp>
#include <apsis/scheme/reconstruction.hpp>
#include <apsis/semidiscrete/upwind_rows.hpp>

#include <memory>
#include <vector>

namespace apsis::bench {

/// The kernels of the sweeps of a step, edges and limited fluxes, on data that stay in the first-level cache:
/// a ceiling for steps with finite differences and the positivity limiter. It has the instructions of a step
/// with their latencies and the edges that neighbouring boxes repeat, and no memory traffic, collision or
/// administration.
class cached_sweeps {
 public:
  /// Sweeps along all directions of the mesh of a case, in runs of as many cells as the boxes of a step have,
  /// into a number of accumulators.
  cached_sweeps(const case_config& config, int accumulators);

  /// Takes a run of cells along each direction, `times` times.
  void evaluate(int times);
  /// Returns the numbers of evaluate(1).
  double numbers() const;

 private:
  struct sweep {
    std::vector<const double*> rows;  ///< of a run of cells, with those beyond its ends
    int cells;
  };

  std::shared_ptr<const reconstruction> scheme_;
  aligned_vector<double> u_, edges_, accumulators_, speeds_, forward_, capacities_;
  std::vector<upwind::row_target> targets_;
  std::vector<sweep> sweeps_;
};

}  // namespace apsis::bench
