#include <apsis/study/limit_distance.hpp>

#include <apsis/core/extremes.hpp>
#include <apsis/model/model_registry.hpp>
#include <apsis/run/simulation.hpp>
#include <apsis/study/limit_scheme.hpp>

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include <fmt/format.h>

namespace apsis {
namespace {

/// Returns max |a − b| / max |b|; max |a − b| if b is 0.
double relative_difference(std::span<const double> a, std::span<const double> b) {
  double difference = 0.0, size = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    difference = maximum(difference, std::abs(a[k] - b[k]));
    size = maximum(size, std::abs(b[k]));
  }
  return size > 0.0 ? difference / size : difference;
}

/// Compared quantities, after the first step and at the end.
struct snapshots {
  std::vector<double> first, end;
};

/// Returns a run of the case with this ε that starts from `state`.
simulation begin(case_config config, double epsilon, const std::vector<double>& state) {
  config.model.epsilon = fmt::format("{:.17g}", epsilon);
  simulation run(config);
  run_state start = run.save();
  start.unknowns = state;
  run.restore(start);
  return run;
}

/// Runs to the end and appends the lengths of the steps to `steps`.
snapshots run_kinetic(simulation run, const study_control& control, std::vector<double>& steps) {
  snapshots at;
  while (!run.finished()) {
    control.check();
    steps.push_back(run.advance().dt);
    if (steps.size() == 1) at.first = run.state();
  }
  at.end = run.state();
  return at;
}

}  // namespace

double limit_table::floor(double limit_row::* column) const {
  const auto smallest = std::min_element(rows.begin(), rows.end(),
                                         [](const auto& a, const auto& b) { return a.epsilon < b.epsilon; });
  return smallest == rows.end() ? std::nan("") : (*smallest).*column;
}

std::optional<double> limit_table::slope(double limit_row::* column, double round_off) const {
  std::vector<std::pair<double, double>> points;
  for (const limit_row& row : rows)
    if (row.epsilon > 0.0 && row.epsilon < 0.1 * dt && row.*column > round_off)
      points.emplace_back(std::log(row.epsilon), std::log(row.*column));
  if (points.size() < 3) return std::nullopt;
  double x = 0.0, y = 0.0, xx = 0.0, xy = 0.0;
  for (const auto& [at, value] : points) {
    x += at / static_cast<double>(points.size());
    y += value / static_cast<double>(points.size());
  }
  for (const auto& [at, value] : points) {
    xx += (at - x) * (at - x);
    xy += (at - x) * (value - y);
  }
  return xy / xx;
}

report_table limit_table::report() const {
  report_table table;
  table.title = fmt::format("{}{}{}, {}: distance to the limit scheme, dt = {:.4g}, {} steps", model,
                            discretization.empty() ? "" : ", ", discretization, method, dt, steps);
  table.columns = {"epsilon", "moments, first step", "moments, end", "state, first step", "state, end"};
  for (const limit_row& row : rows)
    table.rows.push_back({fmt::format("{:.3g}", row.epsilon), fmt::format("{:.3g}", row.moments_first),
                          fmt::format("{:.3g}", row.moments_end), fmt::format("{:.3g}", row.state_first),
                          fmt::format("{:.3g}", row.state_end)});
  std::vector<std::string> slopes = {"slope"};
  for (const auto column :
       {&limit_row::moments_first, &limit_row::moments_end, &limit_row::state_first, &limit_row::state_end}) {
    const auto fitted = slope(column);
    slopes.push_back(fitted ? fmt::format("{:.2f}", *fitted) : "-");
  }
  table.rows.push_back(std::move(slopes));
  return table;
}

limit_table limit_distance(const case_config& config, const std::vector<double>& epsilons, limit_start start,
                           const study_control& control) {
  limit_scheme scheme(config);
  limit_table table;
  table.model = config.model.name;
  table.method = config.time.method;
  if (has_space(find_model(config.model.name))) table.discretization = config.space.discretization;
  std::replace(table.discretization.begin(), table.discretization.end(), '-', ' ');
  const simulation run(config);
  const std::vector<double> given = run.state();
  scheme.limit_for_steps(run.limiter_share());
  const std::vector<double> equilibrium = scheme.equilibrium_of(given);
  table.off_equilibrium = relative_difference(given, equilibrium);
  const std::vector<double>& data = start == limit_start::given ? given : equilibrium;

  const std::size_t count = epsilons.size();
  std::vector<snapshots> kinetic(count);
  std::vector<std::vector<double>> steps(count);
  run_all(control, "runs towards the limit", static_cast<int>(count), [&](int job) {
    const auto k = static_cast<std::size_t>(job);
    kinetic[k] = run_kinetic(begin(config, epsilons[k], data), control, steps[k]);
  });
  if (count == 0 || steps[0].empty()) return table;
  table.dt = steps[0][0];
  table.steps = static_cast<long>(steps[0].size());

  table.rows.resize(count);
  scheme.start(scheme.relaxes_first_stage() ? data : equilibrium);
  for (std::size_t n = 0; n < steps[0].size(); ++n) {
    control.check();
    scheme.step(steps[0][n]);
    const bool first = n == 0, end = n + 1 == steps[0].size();
    if (!first && !end) continue;
    const auto moments = scheme.moments(), state = scheme.equilibrium();
    for (std::size_t k = 0; k < count; ++k) {
      limit_row& row = table.rows[k];
      row.epsilon = epsilons[k];
      const auto compare = [&](const std::vector<double>& u, double& of_moments, double& of_state) {
        of_moments = relative_difference(scheme.moments_of(u), moments);
        of_state = relative_difference(u, state);
      };
      if (first) compare(kinetic[k].first, row.moments_first, row.state_first);
      if (end) compare(kinetic[k].end, row.moments_end, row.state_end);
    }
  }
  return table;
}

std::vector<double> geometric(double first, double last, int count) {
  std::vector<double> values;
  for (int k = 0; k < count; ++k)
    values.push_back(first * std::pow(last / first, count > 1 ? static_cast<double>(k) / (count - 1) : 0.0));
  return values;
}

}  // namespace apsis
