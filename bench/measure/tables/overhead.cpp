#include "../clock.hpp"
#include "../table.hpp"

#include <apsis/integrate/relaxation_problem.hpp>
#include <apsis/integrate/stepper.hpp>
#include <apsis/method/method.hpp>

#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include <fmt/format.h>

namespace apsis::bench::overhead_table {
namespace {

constexpr double epsilon = 1e-4, dt = 1e-3;
constexpr std::size_t stages = 6;

/// The ODE model of the paper, u₁' = u₂, u₂' = (1 + u₁²)(sin u₁ − u₂)/ε, with the stages of md-imex-6-3
/// written out by hand.
class by_hand {
 public:
  by_hand() {
    const auto m = find_method("md-imex-6-3").coefficients<double>();
    for (std::size_t k = 0; k < stages; ++k) {
      start_[k] = 1.0;
      for (std::size_t j = 0; j < k; ++j) {
        weight_[k][j] = m.P(k, j) + m.W(k, j);
        transport_[k][j] = dt * m.W(k, j) / m.r;
        start_[k] -= weight_[k][j];
      }
      a_[k] = dt * m.D(k, k);
      b_[k] = dt * dt * m.ddot[k];
    }
  }

  void step(std::array<double, 2>& u) const {
    std::array<double, stages> v{}, w{};
    for (std::size_t k = 0; k < stages; ++k) {
      double x = start_[k] * u[0], y = start_[k] * u[1];
      for (std::size_t j = 0; j < k; ++j) {
        x += weight_[k][j] * v[j] + transport_[k][j] * w[j];
        y += weight_[k][j] * w[j];
      }
      if (a_[k] != 0.0 || b_[k] != 0.0) {
        const double rate = (1.0 + x * x) / epsilon, mu = a_[k] * rate - b_[k] * rate * rate;
        y = (y + mu * std::sin(x)) / (1.0 + mu);
      }
      v[k] = x;
      w[k] = y;
    }
    u = {v[stages - 1], w[stages - 1]};
  }

 private:
  std::array<double, stages> start_{}, a_{}, b_{};
  std::array<std::array<double, stages>, stages> weight_{}, transport_{};
};

template <class State>
auto ode_problem() {
  return make_relaxation_problem<State>(
      [](double, const State& u, State& out) {
        out[0] = u[1];
        out[1] = 0.0;
      },
      [](const State& u) { return u[0]; },
      [](double u, State& e) {
        e[0] = u;
        e[1] = std::sin(u);
      },
      [](double u) { return 1.0 + u * u; }, epsilon);
}

/// Returns a job of `steps` steps from u by `step`. It stores the last state, so that the compiler cannot
/// remove a step.
template <class State, class Step>
job steps_of(int steps, State u, std::shared_ptr<double> result, Step step) {
  return [steps, u, result, step] {
    State now = u;
    for (int k = 0; k < steps; ++k) step(now);
    *result = now[0];
  };
}

result_table measure(const settings& options) {
  const int steps = options.quick ? 1000 : 200'000;
  const auto result_by_hand = std::make_shared<double>(0.0),
             result_of_library = std::make_shared<double>(0.0);
  using pair = std::array<double, 2>;
  auto small = ode_problem<pair>();
  auto large = ode_problem<std::vector<double>>();
  stepper of_pairs(find_method("md-imex-6-3"), small);
  stepper of_vectors(find_method("md-imex-6-3"), large);
  const by_hand loop;
  const auto seconds = in_turns(
      {steps_of(steps, pair{2.0, 0.0}, result_by_hand, [&](pair& u) { loop.step(u); }),
       steps_of(steps, pair{2.0, 0.0}, result_of_library, [&](pair& u) { of_pairs.step(0.0, dt, u); }),
       steps_of(steps, std::vector<double>{2.0, 0.0}, result_of_library,
                [&](std::vector<double>& u) { of_vectors.step(0.0, dt, u); })},
      options.repeats);
  if (std::abs(*result_by_hand - *result_of_library) > 1e-9)
    throw std::runtime_error("the two solutions differ");
  result_table result;
  result.title = "Library overhead on a tiny problem";
  result.note =
      "The table compares a step of the library with a hand-written step. The library checks every "
      "stage, and the hand-written step has no checks. Both integrate the ODE model of the paper (two "
      "unknowns, ε = 1e-4) with md-imex-6-3.";
  result.columns = {"who", "ns per step", "against by hand"};
  const std::vector<std::string> names = {"by hand", "stepper, std::array", "stepper, std::vector"};
  for (std::size_t k = 0; k < names.size(); ++k)
    result.rows.push_back(
        {names[k], 1e9 * median(seconds[k]) / steps, fmt::format("{:.2f}", median_ratio(seconds, k, 0))});
  return result;
}

const registered here({"overhead", "a step of two unknowns against a hand-written one", measure});

}  // namespace
}  // namespace apsis::bench::overhead_table
