#include <apsis/config/method_of_case.hpp>

#include <apsis/config/prescribed_data.hpp>
#include <apsis/core/errors.hpp>
#include <apsis/mesh/grid.hpp>
#include <apsis/model/expression.hpp>
#include <apsis/scheme/reconstruction_registry.hpp>

#include <algorithm>
#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace apsis {
namespace {

/// Returns a coarse mesh of the domain. Solids and bodies are omitted: their faces lie on edges of
/// the mesh of the case.
grid sample_mesh(const case_config& config) {
  constexpr int per_direction[] = {64, 8, 4};
  case_config sampled = config;
  sampled.solids.clear();
  sampled.bodies.clear();
  const std::size_t dimensions = config.space.domain.size();
  sampled.space.cells.assign(dimensions, per_direction[std::min<std::size_t>(dimensions, 3) - 1]);
  return make_mesh(sampled);
}

/// Returns the longest step of the case, by time.dt or by the CFL rule. time.safety counts as a CFL number,
/// which it resembles.
double step_of(const case_config& config, const model& equation) {
  if (config.time.dt) return *config.time.dt;
  const grid mesh = make_mesh(config);
  std::vector<double> spacing;
  for (int k = 0; k < mesh.dimensions(); ++k) spacing.push_back(mesh.spacing(k));
  return (config.time.cfl ? *config.time.cfl : config.time.safety.value_or(1.0)) / equation.cfl_rate(spacing);
}

/// Returns a function for u ← the initial data of the case at a point of space. It is empty if they
/// are not in the case.
std::function<void(const position&, std::span<double>)> data_of(const case_config& config,
                                                                const model& equation) {
  if (config.prescribed.given_elsewhere()) return {};
  if (!config.prescribed.empty()) {
    const auto given = std::make_shared<const prescribed_data>(
        config, equation, [&config](const std::string& path) { return place_of(config, path); });
    return [given](const position& x, std::span<double> u) { (*given)(x, u); };
  }
  for (const initial_data& named : equation.initial())
    if (config.model.initial.empty() || named.name == config.model.initial) return named.point_value;
  return {};
}

/// Stores the extremes of CΔt/ε over the domain in the request. Leaves them empty if the relaxation time of
/// the model is unknown, or if the data are not admissible, which the run reports.
void compute_ratios(const case_config& config, const model& equation, method_request& wanted) {
  if (!equation.has_relaxation_time()) return;
  const int dimensions = equation.space_dimensions();
  const expression epsilon = make_epsilon(config, dimensions);
  const auto data = data_of(config, equation);
  const auto collision =
      equation.make_collision({.points = 1, .pitch = static_cast<std::ptrdiff_t>(equation.components())});
  std::vector<double> row(static_cast<std::size_t>(equation.components()));
  const double dt = step_of(config, equation);
  double lowest = std::numeric_limits<double>::infinity(), highest = 0.0;
  const auto count = [&](const position& x) {
    const double at = epsilon.evaluate(x);
    double relaxation = at;  // C = 1
    if (data && at > 0.0) {
      data(x, row);
      relaxation = collision->relaxation_time(row.data(), at);
    }
    const double ratio = relaxation > 0.0 ? dt / relaxation : std::numeric_limits<double>::infinity();
    lowest = std::min(lowest, ratio);
    highest = std::max(highest, ratio);
  };
  if (dimensions == 0) {
    count({});
  } else {
    const grid mesh = sample_mesh(config);
    for (int cell = 0; cell < mesh.size(); ++cell) count(mesh.centre(cell));
  }
  wanted.lowest_ratio = lowest;
  wanted.highest_ratio = highest;
}

/// Returns whether a reconstruction keeps signs without a limiter; false for an unknown name.
bool first_order(const std::string& name) {
  const reconstruction_entry* scheme = try_find_reconstruction(name);
  return scheme != nullptr && scheme->make()->order() == 1;
}

}  // namespace

method_request request_of(const case_config& config) {
  const auto equation = make_model(config);
  method_request wanted;
  wanted.space = equation->space_dimensions() > 0;
  wanted.graded_start = config.time.startup == startup_choice::graded;
  wanted.tolerance = config.time.tolerance;
  wanted.longest_steps = wanted.space && !config.time.dt && !config.time.cfl && !config.time.tolerance;
  // time.safety is a fraction of the step that an SSP coefficient bounds.
  wanted.signs = config.time.safety.has_value() || config.space.limiter == limiter_choice::positivity ||
                 (wanted.space && equation->positive() && first_order(config.space.reconstruction));
  try {
    compute_ratios(config, *equation, wanted);
  } catch (const numerical_error&) {
    return wanted;
  }
  return wanted;
}

case_config with_chosen_method(case_config config) {
  if (config.time.method != automatic_method) return config;
  if (config.steady_state.tolerance) {
    config.time.method = "md-imex-3-2";
    config.time.method_reason = "a steady state needs no steps";
    return config;
  }
  method_choice chosen = choose_method(request_of(config));
  config.time.method = std::move(chosen.method);
  config.time.method_reason = std::move(chosen.reason);
  return config;
}

}  // namespace apsis
