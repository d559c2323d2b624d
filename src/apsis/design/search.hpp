#pragma once

#include <apsis/design/nonlinear_program.hpp>

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>

namespace apsis {

/// A design task: kind, order, stages, demands and objective of the method to be found.
struct design_task {
  method_kind kind = method_kind::imex;  ///< class of equations
  std::size_t stages = 3;                ///< number of stages, s, including u^{n−1} with two steps
  int steps = 1;                         ///< 2: stages also depend on u^{n−1} and its T, in the first row
  std::optional<int> transports;         ///< evaluations of T, n_F; if not given, each start draws a number
  design_demands demands;                ///< order, bounds and further requirements
  design_objective objective = design_objective::largest_r;  ///< objective
  double band_weight = default_band_weight;                  ///< w of smallest_band and smallest_mixed
  std::uint64_t seed = 1;  ///< seed of all random numbers, together with the number of the start
  /// Initial method. The first start is this method with every coefficient free that the task allows; the
  /// others are at most a tenth away from it. If the method has fewer stages or evaluations of T than the
  /// task, each start adds the missing ones elsewhere.
  std::optional<shu_osher_form<double>> from;
};

/// A method found by a search, in double precision.
struct design_candidate {
  zero_pattern pattern;  ///< pattern of the unknowns
  Eigen::VectorXd x;     ///< unknowns of the design_problem of this pattern
  double r = 0.0;        ///< SSP coefficient; 1 without transport
  int evaluations = 0;   ///< evaluations of T, n_F
  double error = 0.0;    ///< 2-norm of the residuals of the next order
  double band = 0.0;     ///< 2-norm of band_terms() (IMEX methods)
  double layer = 0.0;    ///< 2-norm of layer_terms() (IMEX methods)
  int start = -1;        ///< number of the start that found it
};

/// Progress of a search.
struct design_progress {
  long starts = 0;    ///< number of finished starts
  long feasible = 0;  ///< number of starts that found an acceptable method
  double best_residual =
      std::numeric_limits<double>::infinity();  ///< minimum over all starts of the largest |residual|
  std::optional<design_candidate> best;         ///< best acceptable candidate so far
};

/// Search limits and callbacks.
struct design_search_options {
  int starts = 1000;  ///< maximum number of starts
  /// Called at the end of each start, by one thread at a time; `improved` marks a new best candidate.
  /// May be empty.
  std::function<void(const design_progress&, bool improved)> report;
  std::function<bool()> stop;  ///< polled frequently; true ends the search. May be empty
};

/// Searches for methods from many starts, on all threads. Each start draws a pattern and coefficients from
/// (seed, start) and searches for a point that satisfies the equations. It optimizes from there and drops
/// coefficients that are zero. The result of a start, and thus of a search with a given number of starts,
/// does not depend on the number of threads.
design_progress search_methods(const design_task& task, const design_search_options& options);

/// Whether a is better than b in the objective of the task; ties go to the earlier start.
bool is_better(const design_task& task, const design_candidate& a, const design_candidate& b);

/// Returns the value of the objective; larger values are better. It is r, r/n_F, −error, −√(error² + (w
/// band)²), or −√(error² + w² (band² + layer²)).
double value_of(const design_task& task, const design_candidate& candidate);

/// Whether a candidate satisfies the requirements that are not equations: buffers, poles, angle and, for two
/// steps, a weight of u^{n−1} of at most 1/2.
bool is_acceptable(const design_task& task, const design_candidate& candidate);

/// Runs one start of a search. Returns nothing if no point satisfies the equations or the resulting method is
/// not acceptable. Sets `residual` to the residual that the search for such a point reached.
std::optional<design_candidate> run_search_start(const design_task& task, int start, double& residual,
                                                 const std::function<bool()>& stop = {});

}  // namespace apsis
