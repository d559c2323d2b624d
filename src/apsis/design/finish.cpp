#include <apsis/design/finish.hpp>

#include <apsis/core/errors.hpp>
#include <apsis/method/intermediate_regime.hpp>
#include <apsis/method/polish.hpp>

#include <cmath>

#include <fmt/format.h>

namespace apsis {
namespace {

/// Formats a value within `near` of a bound as that bound, any other as a decimal long enough to
/// count as inexact.
std::string to_text(double value, double lower, double upper, double near) {
  for (const double bound : {lower, upper})
    if (std::abs(value - bound) <= near) return fmt::format("{}", bound == 0.0 ? 0.0 : bound);
  return fmt::format("{:.14f}", value);
}

std::vector<mp_real> additional_residuals(const design_task& task, const shu_osher_form<mp_real>& m) {
  std::vector<mp_real> equations;
  if (task.kind == method_kind::imex && task.demands.regime != regime_demand::none) {
    const auto terms = analyse_intermediate_regime(m);
    equations = {terms.flux - 1, terms.last - 1};
    if (task.demands.regime == regime_demand::all) equations.push_back(terms.layer - 1);
  }
  if (task.kind != method_kind::implicit_only || task.demands.order < 5) return equations;
  const auto b = to_butcher(m);
  const std::size_t s = m.stages();
  std::vector<mp_real> c(s);
  for (std::size_t i = 0; i < s; ++i)
    for (std::size_t j = 0; j <= i; ++j) c[i] += b.A(i, j);
  for (std::size_t i = 0; i < s; ++i) {
    if (m.D(i, i) == 0) continue;
    mp_real sum = -c[i] * c[i] / 2;
    for (std::size_t j = 0; j <= i; ++j) sum += b.A(i, j) * c[j] + b.A_dot(i, j);
    equations.push_back(sum);
  }
  return equations;
}

/// Converts a candidate to a method; coefficients within `near` of a bound are set to it.
method rounded_method(const design_task& task, const design_candidate& candidate, const std::string& name,
                      double near) {
  const auto text = [near](double value, double lower, double upper) {
    return to_text(value, lower, upper, near);
  };
  const design_problem problem(candidate.pattern, task.demands);
  const std::size_t s = task.stages;
  const auto value = problem.form(candidate.x);
  const auto& limits = task.demands;
  method m;
  m.name = name;
  m.title = fmt::format("designed {} method of order {}", to_string(task.kind), limits.order);
  m.citation = "apsis design";
  m.kind = task.kind;
  m.claims.order = limits.order;
  auto& e = m.exact;
  e.P = e.W = e.D = matrix<std::string>(s, s);
  for (std::size_t i = 0; i < s; ++i) {
    for (std::size_t j = 0; j < s; ++j) {
      e.P(i, j) = text(value.P(i, j), 0.0, 1.0);
      e.W(i, j) = text(value.W(i, j), 0.0, 1.0);
      e.D(i, j) = "0";
    }
    e.D(i, i) = text(value.D(i, i), candidate.pattern.ddot[i] != 0 ? 0.0 : limits.margin, limits.box);
    if (candidate.pattern.d[i] == 0) e.D(i, i) = "0";
    e.ddot.push_back(candidate.pattern.ddot[i] == 0
                         ? "0"
                         : text(value.ddot[i], -limits.largest_ddot(candidate.pattern.d[i] != 0),
                                candidate.pattern.d[i] != 0 ? 0.0 : -limits.margin));
  }
  e.r = problem.place_of_r() >= 0 ? text(value.r, limits.least_r, limits.largest_r) : "1";
  m.claims.ssp_coefficient = problem.place_of_r() >= 0 ? e.r : "unconditional";
  return m;
}

}  // namespace

method to_method(const design_task& task, const design_candidate& candidate, const std::string& name) {
  return rounded_method(task, candidate, name, 0.0);
}

method to_polished_method(const design_task& task, const design_candidate& candidate, const std::string& name,
                          int digits) {
  const auto equations = [&task](const shu_osher_form<mp_real>& m) { return additional_residuals(task, m); };
  // If all coefficients close to bounds are fixed, too few may be left for Newton's method, which then moves
  // far or fails. At the candidate the equations hold to 1e-11.
  constexpr double far = 1e-6;
  method polished;
  bool good = false;
  for (const double near : {1e-9, 1e-12, 1e-7}) {
    try {
      auto result = polish(rounded_method(task, candidate, name, near), digits, equations);
      good = result.largest_move < far;
      polished = std::move(result.polished);
    } catch (const numerical_error&) {
      good = false;
    }
    if (good) break;
  }
  if (!good)
    throw numerical_error(
        fmt::format("'{}' cannot be polished to {} digits (its equations are singular to "
                    "rounding); its digits are those of double precision",
                    name, digits));
  if (polished.claims.ssp_coefficient != "unconditional") polished.claims.ssp_coefficient = polished.exact.r;
  return polished;
}

}  // namespace apsis
