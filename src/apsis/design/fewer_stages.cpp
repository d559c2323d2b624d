#include <apsis/design/fewer_stages.hpp>

#include <apsis/design/draw.hpp>
#include <apsis/design/feasibility.hpp>

#include <algorithm>
#include <numeric>

namespace apsis {
namespace {

using form_type = shu_osher_form<double>;

/// Returns the weight of each stage in others, except for the last stage, which is the result.
std::vector<double> weights_of_stages(const form_type& m) {
  std::vector<double> sums(m.stages() - 1, 0.0);
  for (std::size_t i = 0; i < m.stages(); ++i)
    for (std::size_t j = 0; j < i; ++j) sums[j] += m.P(i, j) + m.W(i, j);
  return sums;
}

form_type without_stage(const form_type& m, std::size_t stage) {
  const std::size_t s = m.stages() - 1;
  const auto old = [stage](std::size_t i) { return i < stage ? i : i + 1; };
  form_type smaller;
  smaller.P = smaller.W = smaller.D = matrix<double>(s, s);
  smaller.ddot.resize(s);
  smaller.r = m.r;
  for (std::size_t i = 0; i < s; ++i) {
    smaller.ddot[i] = m.ddot[old(i)];
    for (std::size_t j = 0; j <= i; ++j) {
      smaller.D(i, j) = m.D(old(i), old(j));
      smaller.P(i, j) = m.P(old(i), old(j));
      smaller.W(i, j) = m.W(old(i), old(j));
    }
  }
  return smaller;
}

design_problem problem_near(const design_task& task, const form_type& m) {
  return {pattern_near(task, m), task.demands};
}

}  // namespace

std::optional<form_type> without_a_stage(const design_task& task, const form_type& m,
                                         const std::function<bool()>& stop,
                                         const std::function<void(std::size_t, double)>& report) {
  // A weight below this is zero within the tolerance of the optimizer.
  constexpr double none = 1e-6;
  const auto given = weights_of_stages(m);
  std::vector<std::size_t> order(given.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(),
            [&given](std::size_t a, std::size_t b) { return given[a] < given[b]; });
  auto problem = problem_near(task, m);
  const Eigen::VectorXd x = problem.unknowns_of(m);
  for (const std::size_t stage : order) {
    if (stop && stop()) return std::nullopt;
    form_type column;
    const std::size_t s = m.stages();
    column.P = column.W = column.D = matrix<double>(s, s);
    column.ddot.assign(s, 0.0);
    const Eigen::VectorXd zero = problem.unknowns_of(column);
    for (std::size_t i = stage + 1; i < s; ++i) column.P(i, stage) = column.W(i, stage) = 1.0;
    // r_i = 1 − Σ_j (p_ij + w_ij) is not a weight of the stage.
    const program_goal goal{(problem.unknowns_of(column) - zero).cwiseMax(0.0)};
    const auto solution = optimize(problem, goal, x, stop);
    const double residual_weight = goal.linear.dot(solution.x);
    if (report) report(stage, solution.residual < 1e-9 ? residual_weight : given[stage]);
    if (!(solution.residual < 1e-9) || residual_weight > none) continue;
    auto smaller = problem_near(task, without_stage(problem.form(solution.x), stage));
    const auto feasible =
        search_feasible(smaller, smaller.unknowns_of(without_stage(problem.form(solution.x), stage)));
    if (feasible.feasible) return smaller.form(feasible.x);
  }
  return std::nullopt;
}

}  // namespace apsis
