#include <apsis/verify/stiff_problem.hpp>

#include <apsis/core/errors.hpp>
#include <apsis/core/suggest.hpp>
#include <apsis/integrate/component_tolerances.hpp>
#include <apsis/integrate/end_error.hpp>
#include <apsis/integrate/error_control.hpp>
#include <apsis/integrate/newton_problem.hpp>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <limits>
#include <type_traits>

#include <fmt/format.h>

namespace apsis {
namespace {

/// G of a piece, as newton_problem expects it; counts its calls.
struct counted_rate {
  const stiff_rate* rate;
  stiff_solution* counts;

  template <class Number>
  void operator()(const Number& t, std::span<const Number> u, std::span<Number> out) const {
    ++counts->evaluations;
    if constexpr (!std::is_same_v<Number, double>) ++counts->products;
    rate->evaluate(t, u, out);
  }
};

double cpu_seconds() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

double size_of(const stiff_problem_entry& problem, std::size_t i) {
  return problem.sizes.size() == 1 ? problem.sizes[0] : problem.sizes[i];
}

}  // namespace

const stiff_problem_entry& find_stiff_problem(const std::string& name) {
  std::vector<std::string> names;
  for (const auto* one : stiff_problem_entries()) {
    if (one->name == name) return *one;
    names.push_back(one->name);
  }
  throw input_error(
      fmt::format("unknown stiff problem '{}' (there is no such name); {}", name, suggest(name, names)));
}

double correct_digits(const stiff_problem_entry& problem, std::span<const double> u) {
  double largest = 0;
  for (const auto& [i, value] : problem.reference) {
    const double error = std::abs(u[i] - value) / (std::abs(value) + size_of(problem, i));
    if (!(error < std::numeric_limits<double>::infinity())) return -std::numeric_limits<double>::infinity();
    largest = std::max(largest, error);
  }
  return -std::log10(largest);
}

std::vector<double> absolute_tolerances(const stiff_problem_entry& problem, double rtol) {
  std::vector<double> absolute(problem.start().size());
  for (std::size_t i = 0; i < absolute.size(); ++i) absolute[i] = rtol * size_of(problem, i);
  return absolute;
}

stiff_solution solve_stiff_problem(const stiff_problem_entry& problem, const std::string& method, double rtol,
                                   long most_steps, double most_seconds) {
  const double begin = cpu_seconds();
  bool in_time = true;
  const component_tolerances<double> tolerances({rtol}, absolute_tolerances(problem, rtol));
  const apsis::method& m = find_method(method);
  stiff_solution found;
  found.u = problem.start();
  for (std::size_t piece = 0; piece + 1 < problem.times.size(); ++piece) {
    const auto rate = problem.rate(piece);
    newton_problem equation(no_transport{}, counted_rate{rate.get(), &found});
    equation.with_tolerances(tolerances);
    if (problem.pattern != nullptr) equation.with_sparsity(problem.pattern());
    stepper march(m, equation, solutions::result_and_embedded);
    step_controller<double> control(1.0, estimate_of(m).order);
    const long before = found.steps;
    const auto done = integrate_to_tolerance(march, found.u, problem.times[piece], problem.times[piece + 1],
                                             step_rule<double>::unlimited(), control, tolerances,
                                             [&](long step, double, double, const std::vector<double>&) {
                                               found.steps = before + step;
                                               in_time = cpu_seconds() - begin <= most_seconds;
                                               return found.steps < most_steps && in_time;
                                             });
    found.rejected += control.rejected();
    if (!in_time)
      throw numerical_error(
          fmt::format("'{}' of '{}' takes more than {:g} s (its steps are at t = {:g}); enlarge the "
                      "tolerance or the time",
                      method, problem.name, most_seconds, done.t));
    if (done.t < problem.times[piece + 1])
      throw numerical_error(
          fmt::format("'{}' of '{}' takes more than {} steps (they are at t = {:g}); enlarge the "
                      "tolerance or the number of steps",
                      method, problem.name, most_steps, done.t));
  }
  found.digits = correct_digits(problem, found.u);
  return found;
}

stiff_solution solve_stiff_problem_to_end(const stiff_problem_entry& problem, const std::string& method,
                                          double rtol, double most_seconds) {
  const double begin = cpu_seconds();
  const component_tolerances<double> wanted({rtol}, absolute_tolerances(problem, rtol));
  stiff_solution all;
  const auto refined = refine_until_accurate(
      [&](double factor) {
        auto found = solve_stiff_problem(problem, method, factor * rtol, std::numeric_limits<long>::max(),
                                         most_seconds - (cpu_seconds() - begin));
        all.steps += found.steps;
        all.rejected += found.rejected;
        all.evaluations += found.evaluations;
        all.products += found.products;
        return found;
      },
      [&](const stiff_solution& coarse, const stiff_solution& fine) { return wanted(coarse.u, fine.u); });
  all.u = refined.solution.u;
  all.digits = refined.solution.digits;
  return all;
}

}  // namespace apsis
