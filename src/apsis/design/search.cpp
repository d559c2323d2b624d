#include <apsis/design/search.hpp>

#include <apsis/design/draw.hpp>
#include <apsis/design/feasibility.hpp>
#include <apsis/design/more_stages.hpp>
#include <apsis/design/sparsify.hpp>
#include <apsis/exec/parallel.hpp>
#include <apsis/integrate/schedule.hpp>
#include <apsis/method/kinds/two_step.hpp>
#include <apsis/method/stability.hpp>

#include <algorithm>
#include <cmath>
#include <mutex>

namespace apsis {

double value_of(const design_task& task, const design_candidate& candidate) {
  switch (task.objective) {
    case design_objective::largest_r:
      return candidate.r;
    case design_objective::efficiency:
      return candidate.r / std::max(1, candidate.evaluations);
    case design_objective::smallest_band:
      return -std::hypot(candidate.error, task.band_weight * candidate.band);
    case design_objective::smallest_mixed:
      return -std::hypot(candidate.error, task.band_weight * candidate.band,
                         task.band_weight * candidate.layer);
    case design_objective::smallest_error:
      break;
  }
  return -candidate.error;
}

bool is_better(const design_task& task, const design_candidate& a, const design_candidate& b) {
  const double value_a = value_of(task, a), value_b = value_of(task, b);
  return value_a != value_b ? value_a > value_b : a.start < b.start;
}

bool is_acceptable(const design_task& task, const design_candidate& candidate) {
  const auto m = design_problem(candidate.pattern, task.demands).form(candidate.x);
  if (schedule(m).buffers() > task.demands.most_buffers) return false;
  // The second root of a two-step method is the negative weight of u^{n−1}. Up to 1/2, errors of alternating
  // sign at least halve in a step.
  if (task.steps == 2 && weight_of_previous(m) > 0.5) return false;
  if (task.kind == method_kind::explicit_only) return true;
  // A tiny d hardly moves the pole.
  constexpr double nearly = 1e-3;
  for (std::size_t i = 0; i < m.stages(); ++i)
    if (m.D(i, i) < nearly && -m.ddot[i] * std::pow(task.demands.least_pole, 2.0) > 1.0) return false;
  if (task.demands.least_angle == 0.0) return true;
  shu_osher_form<long double> exact;
  const auto copy = [](const matrix<double>& from) {
    matrix<long double> to(from.rows(), from.cols());
    for (std::size_t i = 0; i < from.rows(); ++i)
      for (std::size_t j = 0; j < from.cols(); ++j) to(i, j) = from(i, j);
    return to;
  };
  exact.P = copy(m.P);
  exact.W = copy(m.W);
  exact.D = copy(m.D);
  exact.ddot.assign(m.ddot.begin(), m.ddot.end());
  exact.r = m.r;
  return analyse_stability(exact).angle >= task.demands.least_angle;
}

namespace {

/// Returns the same method with the r of its Butcher form: Â = R⁻¹ W/r does not change if W grows with r at
/// the expense of P, until an entry of P is zero.
Eigen::VectorXd with_largest_r(const design_problem& problem, const Eigen::VectorXd& x) {
  auto m = problem.form(x);
  double growth = problem.upper()(problem.place_of_r()) / m.r;
  for (std::size_t i = 0; i < m.stages(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (m.W(i, j) > 0.0) growth = std::min(growth, 1.0 + m.P(i, j) / m.W(i, j));
  for (std::size_t i = 0; i < m.stages(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      m.P(i, j) = std::max(0.0, m.P(i, j) - (growth - 1.0) * m.W(i, j));
      m.W(i, j) *= growth;
    }
  m.r *= growth;
  return problem.unknowns_of(m);
}

/// Optimizes from a feasible point and drops coefficients that are zero. If the optimization ends with an r
/// below that of the Butcher form, it is repeated from the method with the larger r.
design_candidate best_near(const design_task& task, design_problem& problem, Eigen::VectorXd x,
                           const std::function<bool()>& stop) {
  constexpr int most_rounds = 4;
  const bool has_r = task.kind != method_kind::implicit_only;
  const bool for_r =
      task.objective == design_objective::largest_r || task.objective == design_objective::efficiency;
  design_candidate found = drop_zeros(problem, x);
  for (int round = 0; round < most_rounds && (has_r || !for_r); ++round) {
    const auto solution = optimize(problem, goal_of(problem, task.objective, task.band_weight), x, stop);
    if (solution.residual < 1e-9) {
      auto better = drop_zeros(problem, solution.x);
      if (round == 0 || is_better(task, better, found)) found = std::move(better);
    }
    if (!has_r) break;
    design_problem sparse(found.pattern, task.demands);
    const double before = found.r;
    found = drop_zeros(sparse, with_largest_r(sparse, found.x));
    if (!for_r || found.r <= before * (1.0 + 1e-6) || (stop && stop())) break;
    x = problem.unknowns_of(sparse.form(found.x));
  }
  return found;
}

}  // namespace

std::optional<design_candidate> run_search_start(const design_task& task, int start, double& residual,
                                                 const std::function<bool()>& stop) {
  // Hash the start number: seeds of consecutive starts must not be consecutive.
  random_source random(task.seed * 0x9E3779B97F4A7C15ULL +
                       static_cast<std::uint64_t>(start) * 0xD1B54A32D192ED03ULL);
  design_task here = task;
  if (here.from)
    here.from = with_more_stages(*task.from, task.stages, random, static_cast<std::size_t>(task.steps));
  const auto pattern = draw_pattern(here, random);
  design_problem problem(pattern, task.demands);
  const auto feasible = search_feasible(problem, draw_coefficients(here, problem, random, start == 0));
  residual = feasible.residual;
  if (!feasible.feasible || (stop && stop())) return std::nullopt;
  auto found = best_near(task, problem, feasible.x, stop);
  found.start = start;
  if (!is_acceptable(task, found)) return std::nullopt;
  return found;
}

design_progress search_methods(const design_task& task, const design_search_options& options) {
  design_progress progress;
  std::mutex guard;
  const auto stopped = [&options] { return options.stop && options.stop(); };
  parallel_tasks(options.starts, [&](int start) {
    if (stopped()) return;
    double residual = std::numeric_limits<double>::infinity();
    const auto found = run_search_start(task, start, residual, stopped);
    const std::lock_guard lock(guard);
    ++progress.starts;
    progress.best_residual = std::min(progress.best_residual, residual);
    bool improved = false;
    if (found) {
      ++progress.feasible;
      improved = !progress.best || is_better(task, *found, *progress.best);
      if (improved) progress.best = found;
    }
    if (options.report) options.report(progress, improved);
  });
  return progress;
}

}  // namespace apsis
