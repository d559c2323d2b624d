#include <apsis/design/embedded.hpp>

#include <apsis/core/random_source.hpp>
#include <apsis/design/feasibility.hpp>
#include <apsis/design/search.hpp>
#include <apsis/design/sparsify.hpp>

#include <algorithm>
#include <limits>

namespace apsis {
namespace {

/// Given rows as they are, and a last one without u^{n+1}.
zero_pattern extended_pattern(const shu_osher_form<double>& m, method_kind kind, embedded_cost cost) {
  const std::size_t s = m.stages();
  auto pattern = full_pattern(kind, std::vector<char>(s + 1, 1));
  std::vector<char> transport(s, 0);
  for (std::size_t i = 0; i < s; ++i) {
    pattern.d[i] = static_cast<char>(m.D(i, i) != 0.0);
    pattern.ddot[i] = static_cast<char>(m.ddot[i] != 0.0);
    for (std::size_t j = 0; j < i; ++j) {
      pattern.P(i, j) = static_cast<char>(m.P(i, j) != 0.0);
      pattern.W(i, j) = static_cast<char>(m.W(i, j) != 0.0);
      if (m.W(i, j) != 0.0) transport[j] = 1;
    }
  }
  const bool solved = cost == embedded_cost::one_solve;
  for (std::size_t j = 0; j < s; ++j) pattern.W(s, j) = static_cast<char>(solved && transport[j] != 0);
  pattern.P(s, s - 1) = 0;
  pattern.d[s] = pattern.ddot[s] = static_cast<char>(solved);
  return pattern;
}

Eigen::VectorXd draw(const design_problem& problem, random_source& random) {
  Eigen::VectorXd x(problem.unknowns());
  for (Eigen::Index k = 0; k < x.size(); ++k)
    x(k) =
        random.uniform(problem.lower()(k), std::max(problem.lower()(k), std::min(problem.upper()(k), 1.0)));
  return x;
}

}  // namespace

embedded_search find_embedded(const shu_osher_form<double>& m, method_kind kind, int order,
                              embedded_cost cost) {
  design_task task;
  task.kind = kind;
  task.stages = m.stages() + 1;
  task.objective = design_objective::smallest_error;
  task.demands.order = order - 1;
  task.demands.margin = 0.0;
  task.demands.given_rows = m;
  embedded_search result;
  result.nearest = std::numeric_limits<double>::infinity();
  std::optional<design_candidate> best;
  random_source random(1);
  for (int start = 0; start < 8; ++start) {
    design_problem problem(extended_pattern(m, kind, cost), task.demands);
    const auto feasible = find_feasible(problem, draw(problem, random));
    result.nearest = std::min(result.nearest, feasible.residual);
    if (!feasible.feasible) continue;
    const auto solution = optimise(problem, task.objective, feasible.x);
    auto candidate = drop_zeros(problem, solution.residual < 1e-9 ? solution.x : feasible.x);
    candidate.start = start;
    if (!best || is_better(task, candidate, *best)) best = candidate;
  }
  if (!best) return result;
  const auto sparse = sparsify(task, *best, 0.1);
  result.found = embedded_solution{design_problem(sparse.pattern, task.demands).form(sparse.x), sparse.error};
  return result;
}

}  // namespace apsis
