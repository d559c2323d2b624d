#include <apsis/core/extremes.hpp>
#include <apsis/integrate/integrate.hpp>
#include <apsis/run/simulation.hpp>
#include <apsis/study/case_problem.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <paper/claim.hpp>

namespace apsis::paper {
namespace C18_claim {
namespace {

const std::vector<double> epsilons = {0.0, 1e-12, 1e-9, 1e-6, 1e-4, 1e-2, 1e-1, 1.0, 1e2, 1e6, 1e12};
// The entropy is a sum of some hundred terms of order one, each accurate to a few ulp.
constexpr double rounding = 1e-14;
constexpr int steps = 20;

struct combination {
  std::string model, method;
  double epsilon;
};

std::vector<combination> combinations() {
  std::vector<combination> all;
  for (const auto& m : all_entropy_models())
    for (const auto& name : method_names()) {
      const certificate& c = find_certificate(name);
      if (c.kind != method_kind::imex || !(promised_coefficient(c) > 0.0)) continue;
      for (const double epsilon : epsilons) all.push_back({m, name, epsilon});
    }
  return all;
}

case_config upwind_case(const combination& c, int cells) {
  return small_case(c.model, c.method, c.epsilon, cells, {"space.reconstruction=upwind1"});
}

/// Returns the largest increase in a step, relative to 1 + |S|, as monitored in a run.
double increase_in_run(const combination& c, const study_control& control) {
  case_config config = upwind_case(c, 40);
  config.time.dt.reset();
  config.time.safety = 1.0;
  simulation run(config);
  double worst = -std::numeric_limits<double>::infinity();
  for (int n = 0; n < 2 * steps && !run.finished(); ++n) {
    control.check();
    const double before = run.last().entropy;
    worst = maximum(worst, run.advance().entropy_change / (1.0 + std::abs(before)));
  }
  return worst;
}

/// Returns the largest such increase from extreme states, which do not occur in runs.
double increase_from_hostile_data(const combination& c) {
  case_problem problem(upwind_case(c, 12));
  stepper march(problem.setup.integrator().starter(), *problem.equations);
  double worst = -std::numeric_limits<double>::infinity();
  for (field u : adversarial_states(problem, 10, 1e-8, false)) {
    const double dt = march.r() * problem.equations->forward_euler_step(0.0, u);
    double before = entropy_of(problem.setup, u);
    for (int n = 0; n < steps; ++n) {
      march.step(n * dt, dt, u);
      const double after = entropy_of(problem.setup, u);
      if (!(after - before <= worst * (1.0 + std::abs(before))))
        worst = (after - before) / (1.0 + std::abs(before));
      before = after;
    }
  }
  return worst;
}

/// Entropy and smallest value of a built-in case with a method, step by step.
struct entropy_history {
  curve entropy, change;
  double largest_increase = 0.0, smallest_value = 0.0, forward_euler_steps = 0.0;
  int increases = 0;
};

entropy_history violation(const std::string& method, curve_style style, const study_control& control) {
  const auto config = load_case("benchmarks/entropy-violation", {"time.method=" + method});
  simulation run(config);
  entropy_history history{{method, {0.0}, {run.last().entropy}, style}, {method, {}, {}, style}};
  while (!run.finished()) {
    control.check();
    const auto& record = run.advance();
    history.entropy.x.push_back(record.t);
    history.entropy.y.push_back(record.entropy);
    if (record.step > 1) {  // the first step from data out of equilibrium would dominate all others
      history.change.x.push_back(record.t);
      history.change.y.push_back(record.entropy_change);
    }
    history.increases += record.entropy_change > 0.0 ? 1 : 0;
  }
  const auto summary = run.summary();
  history.largest_increase = summary.max_entropy_increase;
  history.smallest_value = summary.min_value;
  const run_setup setup(config);
  history.forward_euler_steps =
      *config.time.dt / setup.make_problem()->forward_euler_step(0.0, setup.initial_state());
  return history;
}

void add_violation(claim_result& result, const study_control& control) {
  const auto bad = violation("imex-trapezoidal", curve_style::line, control),
             good = violation("md-imex-3-2", curve_style::dashed, control);
  result.findings.insert(
      result.findings.end(),
      {at_least("imex-trapezoidal, for contrast: largest increase in a step", bad.largest_increase, 1e-5),
       at_least("number of its 250 steps in which the entropy increases", bad.increases, 50),
       at_least("its smallest value", bad.smallest_value, 0.4),
       at_most("its step over dt_FE of the transport", bad.forward_euler_steps, 1.0),
       at_most("md-imex-3-2 in the same case: largest increase in a step", good.largest_increase, rounding)});
  result.pictures.push_back(
      {"C18-entropy",
       "Broadwell model, ε = 1e-8, first-order upwind, Δt = 0.8 Δt_FE",
       "Left: the entropy decays in every step of md-imex-3-2. The IMEX trapezoidal rule is stable and its "
       "densities stay above 0.4, but the entropy increases in half of its steps, and over long times. "
       "Right: its change in each step except the first.",
       {{"", "t (dimensionless)", "entropy (dimensionless)", false, false, {bad.entropy, good.entropy}, {}},
        {"",
         "t (dimensionless)",
         "change of entropy in a step (dimensionless)",
         false,
         false,
         {bad.change, good.change},
         {}}}});
}

claim_result check(const study_control& control) {
  const auto all = combinations();
  std::vector<double> run(all.size()), hostile(all.size()), limit(all.size());
  run_all(control, "entropy", static_cast<int>(all.size()), [&](int job) {
    const auto k = static_cast<std::size_t>(job);
    run[k] = increase_in_run(all[k], control);
    hostile[k] = increase_from_hostile_data(all[k]);
    case_problem problem(upwind_case(all[k], 12));
    const auto data = adversarial_states(problem, 6, 1e-8, false);
    limit[k] =
        largest_step(problem.setup.integrator().starter(), *problem.equations, std::span<const field>(data),
                     entropy_decay(problem.setup), {.steps = 3, .rung = 1.25, .accuracy = 1e-3})
            .kept;
  });
  claim_result result;
  report_table table{
      "largest step, over dt_FE, for which no extreme state gains entropy in three steps", {"epsilon"}, {}};
  for (const double epsilon : epsilons) table.rows.push_back({fmt::format("{:g}", epsilon)});
  const auto each = epsilons.size();
  for (std::size_t first = 0; first < all.size(); first += each) {
    const auto worst = [&](const std::vector<double>& values) {
      return *std::max_element(values.begin() + static_cast<std::ptrdiff_t>(first),
                               values.begin() + static_cast<std::ptrdiff_t>(first + each));
    };
    const std::string name = all[first].model + ", " + all[first].method;
    const double r = promised_coefficient(find_certificate(all[first].method));
    const double lowest = *std::min_element(limit.begin() + static_cast<std::ptrdiff_t>(first),
                                            limit.begin() + static_cast<std::ptrdiff_t>(first + each));
    result.findings.push_back(
        at_most(name + ": largest relative increase in a run with dt = r dt_FE", worst(run), rounding));
    result.findings.push_back(at_most(name + ": the same from extreme data", worst(hostile), rounding));
    result.findings.push_back(at_least(name + ": largest step without increase, over dt_FE, worst epsilon",
                                       lowest, r * (1 - 2e-3)));
    table.columns.push_back(name);
    for (std::size_t k = 0; k < each; ++k) table.rows[k].push_back(fmt::format("{:.3f}", limit[first + k]));
  }
  result.tables.push_back(std::move(table));
  add_violation(result, control);
  result.remarks = {
      "epsilon from 0 to 1e12, initial data of the models, their equilibrium, and extreme data: unknowns "
      "disturbed over two decades, neighbouring cells that are nearly empty (1e-8), at rest, or full.",
      "Comparators that are L-stable (ars-222, ssp2-222, ssp2-332, ...) were not observed to increase the "
      "entropy before they lost positivity; an undamped method, such as the trapezoidal rule, does."};
  return result;
}

}  // namespace
}  // namespace C18_claim

extern const claim_entry claim_C18;
const claim_entry claim_C18 = {
    .id = "C18",
    .section = "AP and positivity, remark on the entropy",
    .statement =
        "S[f^{n+1}] <= S[f^n] for BGK and Broadwell with first-order upwind, dt <= r dt_FE, for every "
        "epsilon",
    .how =
        "every step of runs and of extreme data, epsilon from 0 to 1e12, every IMEX method with an SSP "
        "coefficient; and a method without one that violates it",
    .check = C18_claim::check};

}  // namespace apsis::paper
