#pragma once

#include "arrays.hpp"

#include <apsis/core/errors.hpp>
#include <apsis/core/log.hpp>
#include <apsis/integrate/error_control.hpp>
#include <apsis/integrate/integrate.hpp>
#include <apsis/integrate/rate_loss.hpp>
#include <apsis/method/method_choice.hpp>
#include <apsis/method/step_law.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

namespace apsis::python {

/// How long steps are: dt or safety · r · Δt_FE, and shorter where the estimated error asks for it.
struct step_choice {
  std::optional<double> dt;                ///< dt, where it is given
  double safety = 1.0;                     ///< factor of r Δt_FE without dt
  std::optional<int> growth;               ///< ratio of the times of a graded start; none: no graded start
  std::optional<double> tolerance;         ///< of the estimated error of a step
  std::string controller{usual_step_law};  ///< with a tolerance: name of the step_law
};

/// Numbers of steps of an integration through several times.
struct step_count {
  long steps = 0,    ///< accepted
      rejected = 0;  ///< rejected for their estimated error
};

/// max_i |a_i − b_i|, or NaN if one is.
inline double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double largest = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double difference = std::abs(a[i] - b[i]);
    if (!(difference <= largest)) largest = difference;
    if (std::isnan(difference)) return difference;
  }
  return largest;
}

/// Returns body(), or false if a function of the user raises an exception: it may refuse a state that only an
/// estimate meets, and the integration reports all others. Interrupts are not suppressed.
template <class Body>
bool without_exceptions(const Body& body) {
  try {
    return body();
  } catch (py::error_already_set& raised) {
    const py::gil_scoped_acquire lock;
    if (!raised.matches(PyExc_Exception)) throw;
    return false;
  }
}

/// Warns on standard error if the method loses terms of size ε in steps of the given length, estimated from u
/// and again at the times of the results (rate_loss.hpp). Returns whether it warned.
template <class Problem, class Difference>
bool warn_of_loss(Problem& problem, const typename Problem::state& u, double t, double end, const method& m,
                  const step_choice& choice, const rate_response& response, bool layer,
                  const Difference& difference) {
  const double dt = std::min(*choice.dt, end - t);
  const auto found = compute_rate_loss(problem, t, u, dt, response, difference, layer);
  if (!found) return false;
  const loss_verdict verdict = judge_loss(*found, 0.0, end - t, choice.tolerance);
  if (!verdict.large) return false;
  std::string remedy = "give a smaller dt";
  for (const choice_row& row : choice_table()) {
    const auto other = compute_rate_response(row.method);
    if (!other || row.method == m.name || row.tolerance_from || row.longest_steps) continue;
    const auto left = compute_rate_loss(problem, t, u, dt, *other, difference, layer);
    if (!left || judge_loss(*left, 0.0, end - t, {}).expected > 0.1 * verdict.expected) continue;
    remedy = "choose method = \"" + row.method + "\", or a smaller dt";
    break;
  }
  log::warning(describe_loss(m.name, *found, t, dt, end, verdict.expected) + "; " + remedy);
  return true;
}

/// Integrates u from t[0] through t[1], t[2], …; record(u) is called at each of these times, and check()
/// after each step. `limited`: the problem knows Δt_FE. Throws what the integrator throws, and input_error
/// if the step size is unknown.
template <class Problem, class Difference, class Record, class Check>
step_count march_through(Problem& problem, typename Problem::state& u, const std::vector<double>& t,
                         const method& m, const step_choice& choice, bool limited,
                         const Difference& difference, const Record& record, const Check& check) {
  if (t.size() < 2)
    throw input_error(
        "the time interval is missing (fewer than two times were given); give at least two, t = (t0, t1)");
  if (!choice.dt && !limited && !choice.tolerance)
    throw input_error(
        "the step size is unknown (neither dt, tolerance nor forward_euler_step is given); give one of them");
  stepper march(m, problem, choice.tolerance ? solutions::result_and_embedded : solutions::result);
  const auto rule = choice.dt ? step_rule<double>::fixed(*choice.dt)
                    : limited ? step_rule<double>::ssp(choice.safety)
                              : step_rule<double>::unlimited();
  std::optional<step_controller<double>> control;
  if (choice.tolerance)
    control.emplace(*choice.tolerance, estimate_of(m).order, find_step_law(choice.controller));
  const auto observe = [&check](long, double, double, const auto&) { check(); };
  // Equal steps alone: with a tolerance the estimated error shortens them.
  const bool watched = choice.dt && !choice.tolerance && !collides_exactly(problem);
  const auto response = watched ? compute_rate_response(m) : std::nullopt;
  bool warned = false;
  step_count count;
  for (std::size_t k = 1; k < t.size(); ++k) {
    if (response && !warned)
      warned = without_exceptions([&] {
        return warn_of_loss(problem, u, t[k - 1], t.back(), m, choice, *response, k == 1 && !choice.growth,
                            difference);
      });
    const auto start = choice.growth && k == 1 ? rule.with(startup::graded, *choice.growth) : rule;
    const auto done =
        control ? integrate_to_tolerance(march, u, t[k - 1], t[k], start, *control, difference, observe)
                : integrate(march, u, t[k - 1], t[k], start, observe);
    count.steps += done.steps;
    record(u);
  }
  if (control) count.rejected = control->rejected();
  return count;
}

}  // namespace apsis::python
