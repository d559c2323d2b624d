#pragma once

#include <apsis/config/case.hpp>
#include <apsis/exec/aligned.hpp>
#include <apsis/scheme/reconstruction.hpp>
#include <apsis/semidiscrete/upwind_rows.hpp>

#include <memory>
#include <vector>

namespace apsis::bench {

/// The kernels of the sweeps of a step, edges and limited fluxes, on data that stay in the first-level cache.
/// Their speed is a ceiling for steps with finite differences and the positivity limiter. They execute the
/// instructions of a step, including the edges that neighbouring boxes repeat. They have no memory traffic,
/// collisions or bookkeeping.
class cached_sweeps {
 public:
  /// Prepares sweeps along all directions of the mesh of a case, into a number of accumulators. Each sweep
  /// has as many cells as the boxes of a step.
  cached_sweeps(const case_config& config, int accumulators);

  /// Sweeps once along each direction, `times` times.
  void evaluate(int times);
  /// Returns how many numbers evaluate(1) processes.
  double numbers() const;

 private:
  struct sweep {
    std::vector<const double*> rows;  ///< rows of the cells of a sweep and of those beyond its ends
    int cells;
  };

  std::shared_ptr<const reconstruction> scheme_;
  aligned_vector<double> u_, edges_, accumulators_, speeds_, forward_, capacities_;
  std::vector<upwind::row_target> targets_;
  std::vector<sweep> sweeps_;
};

}  // namespace apsis::bench
