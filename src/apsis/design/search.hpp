#pragma once

#include <apsis/design/nonlinear_program.hpp>

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>

namespace apsis {

/// A method to be found: kind, order, stages, what is demanded of it and what it is to be best in.
struct design_task {
  method_kind kind = method_kind::imex;  ///< which of T and Q the method has
  std::size_t stages = 3;                ///< number of stages, s
  std::optional<int>
      transports;          ///< evaluations of T, n_F; if not given any number, drawn anew for each start
  design_demands demands;  ///< order, bounds and what else must hold
  design_objective objective = design_objective::largest_r;  ///< what is to be best
  std::uint64_t seed = 1;  ///< of all random numbers, with the number of the start
  /// A method to begin with: the first start is it, with every coefficient free that the task allows, the
  /// others are near it, at most a tenth away. It has the stages of the task, and no more evaluations.
  std::optional<shu_osher_form<double>> from;
};

/// A method that was found, in double precision.
struct design_candidate {
  zero_pattern pattern;  ///< which coefficients are unknowns
  Eigen::VectorXd x;     ///< unknowns of the design_problem of this pattern
  double r = 0.0;        ///< 1 without transport
  int evaluations = 0;   ///< of T, n_F
  double error = 0.0;    ///< 2-norm of the residuals of the next order
  double band = 0.0;     ///< 2-norm of band_terms() (IMEX methods)
  int start = -1;        ///< which start found it
};

/// How far a search is.
struct design_progress {
  long starts = 0;    ///< finished
  long feasible = 0;  ///< satisfied the equations
  double best_residual =
      std::numeric_limits<double>::infinity();  ///< smallest largest |equation| of any start
  std::optional<design_candidate> best;         ///< none before the first that is acceptable
};

/// Starts a search may take, and what is told of them.
struct design_search {
  int starts = 1000;  ///< at most
  /// Called when a start ends, by one thread at a time; `improved`: it is the new best. May be empty.
  std::function<void(const design_progress&, bool improved)> report;
  std::function<bool()> stop;  ///< asked often; true ends the search. May be empty
};

/// Multi-start search, on all threads: each start draws a pattern and coefficients from (seed, start), looks
/// for a point that satisfies the equations, optimises from there and drops coefficients that are zero. A
/// start has the same result on any number of threads, so a search of a given number of starts has, too.
design_progress search(const design_task& task, const design_search& how);

/// Whether a is better than b: in the objective of the task; the earlier start if that is equal.
bool is_better(const design_task& task, const design_candidate& a, const design_candidate& b);

/// What counts: larger is better. r, r/n_F, minus the error, or minus √(error² + (10 band)²).
double value_of(const design_candidate& candidate, design_objective objective);

/// Whether the demands that the equations do not know are met: angle, poles, buffers.
bool is_acceptable(const design_task& task, const design_candidate& candidate);

/// One start of it; nothing if no point satisfies the equations, or the method there is not acceptable.
/// `residual` is how near it came.
std::optional<design_candidate> search_once(const design_task& task, int start, double& residual,
                                            const std::function<bool()>& stop = {});

}  // namespace apsis
