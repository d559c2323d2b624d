#include "stiff_set.hpp"

#include <apsis/core/errors.hpp>

#include <algorithm>
#include <utility>

namespace apsis::bench::peers {
namespace {

sparsity_pattern pattern_of(const stiff_problem_entry& problem) {
  if (problem.pattern != nullptr) return problem.pattern();
  const std::size_t n = problem.start().size();
  return sparsity_pattern::banded(n, n - 1, n - 1);
}

}  // namespace

stiff_system::stiff_system(const stiff_problem_entry& problem)
    : problem_(problem), pattern_(pattern_of(problem)), in_(pattern_.size()), out_(pattern_.size()) {}

std::size_t stiff_system::width() const {
  std::size_t largest = 0;
  for (std::size_t j = 0; j < size(); ++j)
    for (const std::size_t i : pattern_.rows(j)) largest = std::max(largest, i < j ? j - i : i - j);
  return largest;
}

void stiff_system::rate(double t, const double* u, double* out) {
  ++rates_;
  rate_->evaluate(t, {u, size()}, {out, size()});
}

stiff_outcome run_apsis_stiff(const stiff_problem_entry& problem, const std::string& method,
                              const stiff_limits& limits) {
  const stiff_clock clock(limits.seconds);
  stiff_outcome found;
  try {
    auto solved =
        solve_stiff_problem(problem, method, limits.rtol, std::numeric_limits<long>::max(), limits.seconds);
    const auto whole = static_cast<double>(pattern_of(problem).groups().size());
    found.u = std::move(solved.u);
    found.steps = solved.steps;
    found.rates = solved.evaluations - solved.products;
    found.jacobians = static_cast<double>(solved.products) / whole;
  } catch (const numerical_error& failure) {
    found.failure = clock.is_over() ? too_slow : failure.what();
  }
  return found;
}

}  // namespace apsis::bench::peers
