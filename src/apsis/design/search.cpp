#include <apsis/design/search.hpp>

#include <apsis/core/parallel.hpp>
#include <apsis/core/random_source.hpp>
#include <apsis/design/feasibility.hpp>
#include <apsis/design/sparsify.hpp>
#include <apsis/integrate/schedule.hpp>
#include <apsis/method/stability.hpp>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <numeric>

namespace apsis {
namespace {

/// Which of n things, m in all, at random.
std::vector<char> draw_subset(random_source& random, std::size_t n, std::size_t m) {
  std::vector<std::size_t> order(n);
  std::iota(order.begin(), order.end(), 0);
  std::vector<char> chosen(n, 0);
  for (std::size_t k = 0; k < std::min(m, n); ++k) {
    std::swap(order[k],
              order[static_cast<std::size_t>(random.integer(static_cast<int>(k), static_cast<int>(n)))]);
    chosen[order[k]] = 1;
  }
  return chosen;
}

/// Stages of a given method whose T is evaluated.
std::vector<char> transport_of(const shu_osher_form<double>& m) {
  std::vector<char> used(m.stages(), 0);
  for (std::size_t i = 0; i < m.stages(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (m.W(i, j) != 0.0) used[j] = 1;
  return used;
}

/// What a given method has, and every weight besides. Where its d or ḋ is zero, it may stay so for a reason
/// (the intermediate regime, order 5 without transport).
zero_pattern pattern_near(const design_task& task, const shu_osher_form<double>& m) {
  auto pattern = full_pattern(task.kind, transport_of(m));
  const bool stages_differ = task.demands.regime != regime_demand::none ||
                             (task.kind == method_kind::implicit_only && task.demands.order >= 5);
  for (std::size_t i = 0; i < m.stages() && stages_differ; ++i) {
    pattern.d[i] = static_cast<char>(m.D(i, i) != 0.0);
    pattern.ddot[i] = static_cast<char>(m.ddot[i] != 0.0);
  }
  return pattern;
}

zero_pattern draw_pattern(const design_task& task, random_source& random) {
  if (task.from) return pattern_near(task, *task.from);
  const std::size_t s = task.stages;
  std::vector<char> transport(s, 0);
  if (task.kind != method_kind::implicit_only) {
    const int most = static_cast<int>(s) - 1;
    const int evaluations = task.transports ? *task.transports : random.integer(1, most + 1);
    const auto chosen = draw_subset(random, s - 1, static_cast<std::size_t>(evaluations));
    std::copy(chosen.begin(), chosen.end(), transport.begin());
  }
  auto pattern = full_pattern(task.kind, transport);
  if (task.kind == method_kind::imex && task.demands.regime != regime_demand::none)
    for (std::size_t i = 0; i < s; ++i)
      if (i + 1 == s || random.one_in(2)) pattern.ddot[i] = 0;
  // Order 5 of a method without transport depends on which stages have d > 0 (see order_equations).
  if (task.kind == method_kind::implicit_only && task.demands.order >= 5)
    for (std::size_t i = 0; i < s; ++i) pattern.d[i] = static_cast<char>(!random.one_in(3));
  return pattern;
}

/// Coefficients of any size the bounds allow; rows of few weights, as those of good methods are.
Eigen::VectorXd draw_coefficients(const design_task& task, design_problem& problem, random_source& random,
                                  bool is_first) {
  if (task.from) {
    Eigen::VectorXd x = problem.unknowns_of(*task.from);
    const double away = is_first ? 0.0 : random.magnitude(-4.0, -1.0);
    for (double& value : x) value += away * random.uniform(-1.0, 1.0);
    return x.cwiseMax(problem.lower()).cwiseMin(problem.upper());
  }
  const auto& pattern = problem.pattern();
  const std::size_t s = pattern.stages();
  shu_osher_form<double> m;
  m.P = m.W = m.D = matrix<double>(s, s);
  m.ddot.assign(s, 0.0);
  const auto weight = [&random] { return random.one_in(2) ? 0.0 : -std::log(1.0 - random.uniform()); };
  for (std::size_t i = 1; i < s; ++i) {
    double sum = pattern.initial[i] != 0 ? weight() : 0.0;
    for (std::size_t j = 0; j < i; ++j) {
      if (pattern.P(i, j) != 0) sum += m.P(i, j) = weight();
      if (pattern.W(i, j) != 0) sum += m.W(i, j) = weight();
    }
    for (std::size_t j = 0; j < i && sum > 0.0; ++j) {
      m.P(i, j) /= sum;
      m.W(i, j) /= sum;
    }
  }
  const double size = random.uniform(0.3, 1.0) * std::min(task.demands.box, 4.0);
  for (std::size_t i = 0; i < s; ++i) {
    m.D(i, i) = pattern.d[i] != 0 ? size * std::pow(random.uniform(), 2.0) : 0.0;
    m.ddot[i] = pattern.ddot[i] != 0 ? -size * std::pow(random.uniform(), 2.0) : 0.0;
  }
  const auto transport = pattern.transport();
  const auto evaluations = static_cast<double>(std::count(transport.begin(), transport.end(), 1));
  m.r = random.uniform(0.1, 0.8) * std::max(1.0, evaluations);
  return problem.unknowns_of(m).cwiseMax(problem.lower()).cwiseMin(problem.upper());
}

}  // namespace

double value_of(const design_candidate& candidate, design_objective objective) {
  switch (objective) {
    case design_objective::largest_r:
      return candidate.r;
    case design_objective::efficiency:
      return candidate.r / std::max(1, candidate.evaluations);
    case design_objective::smallest_error:
      break;
  }
  return -candidate.error;
}

bool is_better(const design_task& task, const design_candidate& a, const design_candidate& b) {
  const double value_a = value_of(a, task.objective), value_b = value_of(b, task.objective);
  return value_a != value_b ? value_a > value_b : a.start < b.start;
}

bool is_acceptable(const design_task& task, const design_candidate& candidate) {
  const auto m = design_problem(candidate.pattern, task.demands).form(candidate.x);
  if (schedule(m).buffers() > task.demands.most_buffers) return false;
  if (task.kind == method_kind::explicit_only) return true;
  for (std::size_t i = 0; i < m.stages(); ++i)
    if (m.D(i, i) == 0.0 && -m.ddot[i] * std::pow(task.demands.least_pole, 2.0) > 1.0) return false;
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
  return analyse_stability(to_butcher(exact)).angle >= task.demands.least_angle;
}

std::optional<design_candidate> search_once(const design_task& task, int start, double& residual,
                                            const std::function<bool()>& stop) {
  // Seeds of neighbouring starts must not be neighbours.
  random_source random(task.seed * 0x9E3779B97F4A7C15ULL +
                       static_cast<std::uint64_t>(start) * 0xD1B54A32D192ED03ULL);
  const auto pattern = draw_pattern(task, random);
  design_problem problem(pattern, task.demands);
  const auto feasible = find_feasible(problem, draw_coefficients(task, problem, random, start == 0));
  residual = feasible.residual;
  if (!feasible.feasible || (stop && stop())) return std::nullopt;
  Eigen::VectorXd best = feasible.x;
  if (task.kind != method_kind::implicit_only || task.objective == design_objective::smallest_error) {
    const auto solution = optimise(problem, task.objective, feasible.x, stop);
    if (solution.residual < 1e-9) best = solution.x;
  }
  auto found = drop_zeros(problem, best);
  found.start = start;
  if (!is_acceptable(task, found)) return std::nullopt;
  return found;
}

design_progress search(const design_task& task, const design_search& how) {
  design_progress progress;
  std::mutex guard;
  const auto stopped = [&how] { return how.stop && how.stop(); };
  parallel_tasks(how.starts, [&](int start) {
    if (stopped()) return;
    double residual = std::numeric_limits<double>::infinity();
    const auto found = search_once(task, start, residual, stopped);
    const std::lock_guard lock(guard);
    ++progress.starts;
    progress.best_residual = std::min(progress.best_residual, residual);
    bool improved = false;
    if (found) {
      ++progress.feasible;
      improved = !progress.best || is_better(task, *found, *progress.best);
      if (improved) progress.best = found;
    }
    if (how.report) how.report(progress, improved);
  });
  return progress;
}

}  // namespace apsis
