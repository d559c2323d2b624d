#include "integrators.hpp"
#include "measure/clock.hpp"
#include "stiff_task.hpp"

#include <apsis/core/errors.hpp>
#include <apsis/integrate/error_control.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

namespace apsis::bench::peers {
namespace {

/// The paper's model; `Definition` of relaxation_task.
struct ode_model {
  static auto problem(double epsilon) { return ode_problem(epsilon); }
  static stiff_task::state initial() { return {2.0, 0.0}; }
  static ode_state<long double> exact(double epsilon) { return ode_reference(epsilon); }
  static stiff_task::state transport(const stiff_task::state& u) { return {u[1], 0.0}; }
  static Eigen::Matrix2d transport_jacobian(const stiff_task::state&) {
    return Eigen::Matrix2d{{0.0, 1.0}, {0.0, 0.0}};
  }
  static double equilibrium(double w) { return std::sin(w); }
  static double equilibrium_slope(double w) { return std::cos(w); }
  static double rate(double w) { return 1.0 + w * w; }
  static double rate_slope(double w) { return 2.0 * w; }
};

/// Returns the problem of a definition with constant rate 1, for the library.
template <class Definition>
auto problem_of(double epsilon) {
  using state = stiff_task::state;
  return make_relaxation_problem<state>(
      [](double, const state& u, state& out) { out = Definition::transport(u); },
      [](const state& u) { return u[0]; },
      [](double w, state& out) { out = {w, Definition::equilibrium(w)}; }, [](double) { return 1.0; },
      epsilon);
}

struct kaps {
  static auto problem(double epsilon) { return problem_of<kaps>(epsilon); }
  static stiff_task::state initial() { return {1.0, 1.0}; }
  static ode_state<long double> exact(double) { return {std::exp(-1.0L), std::exp(-2.0L)}; }
  static stiff_task::state transport(const stiff_task::state& u) {
    return {u[1] - u[0] - u[0] * u[0], -2.0 * u[1]};
  }
  static Eigen::Matrix2d transport_jacobian(const stiff_task::state& u) {
    return Eigen::Matrix2d{{-1.0 - 2.0 * u[0], 1.0}, {0.0, -2.0}};
  }
  static double equilibrium(double w) { return w * w; }
  static double equilibrium_slope(double w) { return 2.0 * w; }
  static double rate(double) { return 1.0; }
  static double rate_slope(double) { return 0.0; }
};

struct prothero_robinson {
  static constexpr double phase = std::numbers::pi / 4.0;
  static auto problem(double epsilon) { return problem_of<prothero_robinson>(epsilon); }
  static stiff_task::state initial() { return {0.0, std::sin(phase)}; }
  static ode_state<long double> exact(double) {
    return {1.0L, std::sin(std::numbers::pi_v<long double> / 4 + 1)};
  }
  static stiff_task::state transport(const stiff_task::state& u) { return {1.0, std::cos(phase + u[0])}; }
  static Eigen::Matrix2d transport_jacobian(const stiff_task::state& u) {
    return Eigen::Matrix2d{{0.0, 0.0}, {-std::sin(phase + u[0]), 0.0}};
  }
  static double equilibrium(double w) { return std::sin(phase + w); }
  static double equilibrium_slope(double w) { return std::cos(phase + w); }
  static double rate(double) { return 1.0; }
  static double rate_slope(double) { return 0.0; }
};

/// Returns |u − v|/|u| in the 2-norm.
double relative_distance(const stiff_task::state& u, const stiff_task::state& v) {
  return std::hypot(u[0] - v[0], u[1] - v[1]) / std::hypot(u[0], u[1]);
}

/// Limit on the number of steps, the same as for SUNDIALS in sundials_ode.cpp.
constexpr long most_steps = 20000;

template <class Definition>
class relaxation_task : public stiff_task {
 public:
  explicit relaxation_task(double epsilon) : stiff_task(epsilon, Definition::exact(epsilon)) {}

  state initial() const override { return Definition::initial(); }
  state transport(const state& u) const override { return Definition::transport(u); }
  state collision(const state& u) const override {
    return {0.0, Definition::rate(u[0]) * (Definition::equilibrium(u[0]) - u[1]) / epsilon()};
  }
  Eigen::Matrix2d transport_jacobian(const state& u) const override {
    return Definition::transport_jacobian(u);
  }
  Eigen::Matrix2d collision_jacobian(const state& u) const override {
    const double rate = Definition::rate(u[0]), off = Definition::equilibrium(u[0]) - u[1];
    return Eigen::Matrix2d{
        {0.0, 0.0},
        {(Definition::rate_slope(u[0]) * off + rate * Definition::equilibrium_slope(u[0])) / epsilon(),
         -rate / epsilon()}};
  }

  outcome run(const std::string& name, long steps, int growth) const override {
    auto problem = Definition::problem(epsilon());
    auto rule = step_rule<double>::fixed(1.0 / static_cast<double>(steps));
    if (growth != 0) rule = rule.with(startup::graded, growth);
    return with_integrator(name, problem, [&](auto& march) {
      return measure([&](state& u, auto&& observer) { integrate(march, u, 0.0, 1.0, rule, observer); });
    });
  }

  outcome run_to_tolerance(const method& m, double tolerance) const override {
    auto problem = Definition::problem(epsilon());
    stepper march(m, problem, solutions::result_and_embedded);
    return measure([&](state& u, auto&& observer) {
      step_controller<double> control(tolerance, m.embedded->order);
      integrate_to_tolerance(march, u, 0.0, 1.0, step_rule<double>::unlimited(), control, relative_distance,
                             observer);
    });
  }

 private:
  template <class Run>
  outcome measure(const Run& run) const {
    outcome measured;
    measured.smallest = std::numeric_limits<double>::infinity();
    state u = initial();
    try {
      run(u, [&](long step, double, double, const state& now) {
        measured.smallest = std::min({measured.smallest, now[0], now[1]});
        measured.steps = step;
        return step < most_steps;
      });
      if (measured.steps >= most_steps) {
        measured.failure = "too many steps";
        return measured;
      }
      measured.seconds = seconds_per_call([&] {
        u = initial();
        run(u, no_observer{});
      });
    } catch (const numerical_error&) {
      measured.failure = "failed";
    }
    measured.error = error(u);
    measured.smallest_final = std::min(u[0], u[1]);
    return measured;
  }
};

}  // namespace

double seconds_per_call(const std::function<void()>& body) {
  constexpr double enough = 1e-3;
  for (long calls = 1;; calls *= 4) {
    const double begin = thread_seconds();
    for (long k = 0; k < calls; ++k) body();
    const double seconds = thread_seconds() - begin;
    if (seconds > enough) return seconds / static_cast<double>(calls);
  }
}

std::unique_ptr<stiff_task> make_ode_model(double epsilon) {
  return std::make_unique<relaxation_task<ode_model>>(epsilon);
}

std::unique_ptr<stiff_task> make_kaps(double epsilon) {
  return std::make_unique<relaxation_task<kaps>>(epsilon);
}

std::unique_ptr<stiff_task> make_prothero_robinson(double epsilon) {
  return std::make_unique<relaxation_task<prothero_robinson>>(epsilon);
}

}  // namespace apsis::bench::peers
