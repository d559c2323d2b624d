#include "integrators.hpp"
#include "kinetic_task.hpp"
#include "measure/clock.hpp"

#include <apsis/integrate/error_control.hpp>
#include <apsis/integrate/extrapolation.hpp>
#include <apsis/model/expression.hpp>
#include <apsis/scheme/quartic.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

namespace apsis::bench::peers {
namespace {

double smallest_of(const field& u) {
  double smallest = std::numeric_limits<double>::infinity();
  for (int cell = 0; cell < u.cells(); ++cell)
    for (int k = 0; k < u.components(); ++k) smallest = std::min(smallest, u.row(cell)[k]);
  return smallest;
}

/// Returns the overrides with the end time, and with a method, which the task does not use.
std::vector<std::string> with_end(std::vector<std::string> overrides, double end) {
  overrides.insert(overrides.end(), {"time.method=md-imex-3-2", fmt::format("time.end={:.17g}", end)});
  return overrides;
}

}  // namespace

void run_monitor::start() {
  smallest_ = std::numeric_limits<double>::infinity();
  begin_ = thread_seconds();
}

bool run_monitor::stepped(const field& u) {
  seconds_ += thread_seconds() - begin_;
  ++steps_;
  smallest_ = std::min(smallest_, smallest_of(u));
  begin_ = thread_seconds();
  return seconds_ < allowed_;
}

outcome run_monitor::result(const field& u) const {
  outcome what;
  what.seconds = seconds_;
  what.smallest = smallest_;
  what.smallest_final = smallest_of(u);
  what.steps = steps_;
  return what;
}

kinetic_task::kinetic_task(const std::string& case_name, std::vector<std::string> overrides, double end)
    : config_(load_case(case_name, with_end(std::move(overrides), end))),
      end_(end),
      setup_(config_),
      problem_(setup_.make_problem()),
      smooth_(problem_builder(setup_.builder()).with_smooth_collisions().build()),
      exact_(problem_builder(setup_.builder()).with_exact_collision().build()),
      initial_(setup_.initial_state()) {
  const auto& [from, to] = config_.space.domain.front();
  const double dx = (to - from) / config_.space.cells.front();
  const expression formula = make_epsilon(config_, 1);
  for (int cell = 0; cell < setup_.mesh().size(); ++cell) {
    const double centre = setup_.mesh().centre(cell, 0);
    double mean = 0.0;
    for (const auto& [offset, weight] : setup_.builder().collisions().points)
      mean += weight / formula.evaluate(centre + offset * dx);
    rates_.push_back(mean);
  }
}

std::unique_ptr<collision_inverse> kinetic_task::inverse() const {
  return config_.model.name == "broadwell" ? make_broadwell_inverse(rates_)
                                           : make_bgk_inverse(equation(), rates_);
}

/// Returns the problem for an integrator. problem_ and smooth_ differ only for collisions at
/// centres (problem_builder::with_smooth_collisions()).
semidiscrete_problem& kinetic_task::problem_of(const std::string& integrator) const {
  const time_integrator& m = find_integrator(integrator);
  if (m.needs.exact_collision) return *exact_;
  return m.ssp_coefficient > 0.0 && !m.needs.explicit_collision ? *problem_ : *smooth_;
}

long kinetic_task::positive_steps(const std::string& name) const {
  const time_integrator& m = find_integrator(name);
  const double r = m.file() != nullptr ? m.form.r : 1.0;
  return static_cast<long>(std::ceil(end_ / (r * problem_->forward_euler_step(0.0, initial_))));
}

template <class Run>
outcome kinetic_task::measure(double seconds_allowed, field* result, const Run& run) {
  field u = initial_;
  run_monitor timer(seconds_allowed);
  bool in_time = true;
  std::string failure;
  try {
    run(u, [&](long step, double, double, const field& now) {
      if (step == 0)
        timer.start();
      else
        in_time = timer.stepped(now);
      return in_time;
    });
  } catch (const numerical_error&) {
    failure = "failed";
  }
  outcome what = timer.result(u);
  what.failure = in_time ? failure : "too slow";
  what.error = error(u);
  if (!std::isfinite(what.error) && failure.empty()) what.failure = "failed";
  if (result != nullptr) *result = u;
  return what;
}

outcome kinetic_task::run(const std::string& name, long steps, bool graded, double seconds_allowed,
                          field* result) {
  const auto rule = step_rule<double>::fixed(end_ / static_cast<double>(steps))
                        .with(graded ? startup::graded : startup::none);
  const auto run = [&](auto& march) {
    return measure(seconds_allowed, result,
                   [&](field& u, auto&& observer) { integrate(march, u, 0.0, end_, rule, observer); });
  };
  return with_integrator(name, problem_of(name), run);
}

outcome kinetic_task::run_to_tolerance(const method& m, double tolerance, double seconds_allowed) {
  stepper march(m, problem_of(m.name), solutions::result_and_embedded);
  step_controller<double> control(tolerance, m.embedded->order);
  return measure(seconds_allowed, nullptr, [&](field& u, auto&& observer) {
    integrate_to_tolerance(
        march, u, 0.0, end_, step_rule<double>::unlimited(), control,
        [](const field& a, const field& b) { return distance(b, a); }, observer);
  });
}

field kinetic_task::extrapolated(double tolerance) {
  field u = initial_;
  extrapolate(*problem_, u, 0.0, end_, {.tolerance = tolerance},
              [](const field& a, const field& b) { return distance(b, a); });
  return u;
}

double kinetic_task::distance(const field& u, const field& exact) {
  if (exact.cells() == 0) return 0.0;
  double difference = 0.0, size = 0.0;
  for (int cell = 0; cell < u.cells(); ++cell)
    for (int k = 0; k < u.components(); ++k) {
      const double e = exact.row(cell)[k], d = u.row(cell)[k] - e;
      difference += d * d;
      size += e * e;
    }
  return std::sqrt(difference / size);
}

}  // namespace apsis::bench::peers
