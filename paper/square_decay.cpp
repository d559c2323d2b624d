#include <paper/square_decay.hpp>

#include <apsis/core/errors.hpp>
#include <apsis/core/extremes.hpp>
#include <apsis/integrate/integrate.hpp>
#include <apsis/integrate/newton_problem.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace apsis::paper {
namespace {

constexpr auto square = [](const auto& u, auto& out) { out[0] = -10 * u[0] * u[0]; };

/// The problem, which records the smallest stage as the stages are solved.
struct watched_decay : newton_problem<no_transport, decltype(square)> {
  watched_decay() : newton_problem(no_transport{}, square) {}
  void solve_collision(double t, double a, double b, std::vector<double>& u) {
    newton_problem::solve_collision(t, a, b, u);
    lowest_stage = minimum(lowest_stage, u[0]);
  }
  double lowest_stage = std::numeric_limits<double>::infinity();
};

}  // namespace

std::vector<std::string> methods_where(const std::function<bool(const certificate&)>& condition) {
  std::vector<std::string> chosen;
  for (const auto& name : method_names())
    if (condition(find_certificate(name))) chosen.push_back(name);
  return chosen;
}

std::vector<std::string> unconditional_methods() {
  return methods_where(
      [](const certificate& c) { return c.kind == method_kind::implicit_only && c.unconditional; });
}

decay_run square_decay(const std::string& method, double dt, int steps) {
  watched_decay problem;
  stepper march(find_method(method), problem);
  std::vector<double> u{10.0};
  decay_run run{{0.0}, u};
  for (int n = 0; n < steps; ++n) {
    try {
      march.step(n * dt, dt, u);
    } catch (const numerical_error&) {
      run.solvable = false;
      break;
    }
    run.decreasing = run.decreasing && u[0] < run.u.back();
    run.positive = run.positive && u[0] > 0.0;
    run.t.push_back((n + 1) * dt);
    run.u.push_back(u[0]);
  }
  run.positive = run.positive && problem.lowest_stage > 0.0;
  return run;
}

double square_decay_exact(double t) {
  return 1.0 / (0.1 + 10.0 * t);
}

double square_decay_error(const std::string& method, long steps) {
  auto problem = make_newton_problem<std::vector<long double>>(no_transport{}, square);
  stepper march(find_method(method), problem);
  std::vector<long double> u{10};
  integrate(march, u, 0.0L, 2.0L, step_rule<long double>::fixed(2.0L / static_cast<long double>(steps)));
  return static_cast<double>(std::abs(u[0] - 1 / 20.1L));
}

}  // namespace apsis::paper
