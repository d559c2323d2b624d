#include <apsis/design/sparsify.hpp>

#include <apsis/design/feasibility.hpp>

#include <algorithm>
#include <cmath>

namespace apsis {
namespace {

design_candidate candidate_of(design_problem& problem, const Eigen::VectorXd& x) {
  design_candidate c;
  c.pattern = problem.pattern();
  c.x = x;
  c.r = problem.place_of_r() >= 0 ? x(problem.place_of_r()) : 1.0;
  const auto transport = c.pattern.transport();
  c.evaluations = static_cast<int>(std::count(transport.begin(), transport.end(), 1));
  c.error = std::sqrt(2.0 * problem.half_square(design_problem::measure::error, x));
  if (c.pattern.kind == method_kind::imex) {
    c.band = std::sqrt(2.0 * problem.half_square(design_problem::measure::band, x));
    c.layer = std::sqrt(2.0 * problem.half_square(design_problem::measure::layer, x));
  }
  return c;
}

/// A coefficient of a pattern.
struct place {
  matrix<char> zero_pattern::* weights = nullptr;
  std::vector<char> zero_pattern::* entries = nullptr;
  std::size_t i = 0, j = 0;
  double size = 0.0;

  char& in(zero_pattern& pattern) const {
    return weights != nullptr ? (pattern.*weights)(i, j) : (pattern.*entries)[i];
  }
};

/// Returns all coefficients that may be removed, smallest first. Of d and ḋ of a stage, at least one is kept.
std::vector<place> places_of(design_problem& problem, const Eigen::VectorXd& x) {
  const auto m = problem.form(x);
  const auto initial = initial_weights(m);
  const auto& pattern = problem.pattern();
  const auto& given = problem.demands().given_rows;
  std::vector<place> all;
  for (std::size_t i = given ? given->stages() : 0; i < m.stages(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (pattern.P(i, j) != 0) all.push_back({&zero_pattern::P, nullptr, i, j, m.P(i, j)});
      if (pattern.W(i, j) != 0) all.push_back({&zero_pattern::W, nullptr, i, j, m.W(i, j)});
    }
    if (i > 0 && pattern.initial[i] != 0) all.push_back({nullptr, &zero_pattern::initial, i, 0, initial[i]});
    if (pattern.d[i] == 0 || pattern.ddot[i] == 0) continue;
    if (m.D(i, i) < -m.ddot[i]) {
      all.push_back({nullptr, &zero_pattern::d, i, 0, m.D(i, i)});
    } else {
      all.push_back({nullptr, &zero_pattern::ddot, i, 0, -m.ddot[i]});
    }
  }
  std::sort(all.begin(), all.end(), [](const place& a, const place& b) { return a.size < b.size; });
  return all;
}

}  // namespace

design_candidate drop_zeros(design_problem& problem, const Eigen::VectorXd& x, double zero) {
  zero_pattern pattern = problem.pattern();
  for (const auto& coefficient : places_of(problem, x))
    if (coefficient.size < zero) coefficient.in(pattern) = 0;
  design_problem smaller(pattern, problem.demands());
  const auto again = search_feasible(smaller, smaller.unknowns_of(problem.form(x)));
  if (again.feasible) return candidate_of(smaller, again.x);
  return candidate_of(problem, search_feasible(problem, x).x);
}

design_candidate sparsify(const design_task& task, design_candidate candidate, double tolerance,
                          const std::function<bool()>& stop) {
  const double best = value_of(task, candidate);
  const double worst = best - tolerance * std::abs(best);
  for (bool changed = true; changed;) {
    changed = false;
    design_problem problem(candidate.pattern, task.demands);
    for (const auto& coefficient : places_of(problem, candidate.x)) {
      if (stop && stop()) return candidate;
      zero_pattern pattern = candidate.pattern;
      coefficient.in(pattern) = 0;
      design_problem smaller(pattern, task.demands);
      const auto feasible = search_feasible(smaller, smaller.unknowns_of(problem.form(candidate.x)));
      if (!feasible.feasible) continue;
      const auto solution =
          optimize(smaller, goal_of(smaller, task.objective, task.band_weight), feasible.x, stop);
      if (!(solution.residual < 1e-9)) continue;
      auto proposal = drop_zeros(smaller, solution.x);
      if (value_of(task, proposal) < worst || !is_acceptable(task, proposal)) continue;
      proposal.start = candidate.start;
      candidate = proposal;
      changed = true;
      break;
    }
  }
  return candidate;
}

}  // namespace apsis
