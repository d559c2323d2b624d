#pragma once

#include "arrays.hpp"

#include <apsis/core/errors.hpp>
#include <apsis/integrate/error_control.hpp>
#include <apsis/integrate/integrate.hpp>

#include <cmath>
#include <optional>
#include <vector>

namespace apsis::python {

/// How long steps are: dt or safety · r · Δt_FE, and shorter where the estimated error asks for it.
struct step_choice {
  std::optional<double> dt;         ///< dt, where it is given
  double safety = 1.0;              ///< factor of r Δt_FE without dt
  std::optional<int> growth;        ///< ratio of the times of a graded start; none: no graded start
  std::optional<double> tolerance;  ///< of the estimated error of a step
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
  if (choice.tolerance) control.emplace(*choice.tolerance, estimate_of(m).order);
  const auto observe = [&check](long, double, double, const auto&) { check(); };
  step_count count;
  for (std::size_t k = 1; k < t.size(); ++k) {
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
