#include <paper/limit_solution.hpp>

#include <apsis/core/errors.hpp>
#include <apsis/run/setup.hpp>
#include <apsis/study/outcome.hpp>

#include <algorithm>
#include <cmath>

namespace apsis::paper {
namespace {

const relaxation_model& relaxation_of(const run_setup& setup) {
  return *setup.equation->as_relaxation();
}

const initial_data& data_of(const case_config& config, const model& equation) {
  const auto& all = equation.initial();
  const auto found = std::find_if(all.begin(), all.end(), [&](const auto& data) {
    return config.model.initial.empty() || data.name == config.model.initial;
  });
  return *found;  // the case was validated, so the data exist
}

outcome compute_limit(case_config config, const study_control& control) {
  config.model.epsilon = "0";
  return compute_outcome(config, control);
}

}  // namespace

fourier_solution limit_solution(const case_config& config, int points, int steps) {
  const auto system = written_limit(config);
  if (!system)
    throw input_error("the limit system of model '" + config.model.name +
                      "' is not written out (a new model does not need to); compare with the limit scheme");
  const run_setup setup(config);
  const auto& equation = relaxation_of(setup);
  const initial_data& data = data_of(config, equation);
  std::vector<double> u(static_cast<std::size_t>(equation.components()));
  return {*system,
          setup.has_space() ? config.space.domain[0][0] : 0.0,
          setup.has_space() ? config.space.domain[0][1] : 1.0,
          points,
          [&](double x, std::span<double> omega) {
            data.point_value({x}, u);
            equation.moments(u.data(), omega.data());
          },
          config.time.end,
          steps};
}

double distance_from_limit_solution(const case_config& config, const fourier_solution& solution,
                                    const study_control& control) {
  const run_setup setup(config);
  const auto& equation = relaxation_of(setup);
  const outcome run = compute_limit(config, control);
  const bool averages = setup.has_space() && !setup.builder().of_space().unknown().pointwise();
  const double h = averages ? run.cell_volume : 0.0;
  std::vector<double> omega(static_cast<std::size_t>(equation.moment_count()));
  std::vector<double> difference(omega.size(), 0.0), size(omega.size(), 0.0);
  for (int i = 0; i < run.cells; ++i) {
    equation.moments(run.state.data() + static_cast<std::ptrdiff_t>(i) * run.components, omega.data());
    for (std::size_t k = 0; k < omega.size(); ++k) {
      const double x = setup.has_space() ? run.fields.x[static_cast<std::size_t>(i)] : 0.0;
      const double exact = solution.average(static_cast<int>(k), x, h);
      difference[k] += (omega[k] - exact) * (omega[k] - exact);
      size[k] += exact * exact;
    }
  }
  double sum = 0.0;
  for (std::size_t k = 0; k < omega.size(); ++k) sum += std::sqrt(difference[k] / size[k]);
  return sum;
}

riemann_comparison compare_with_riemann_solution(const case_config& config, const study_control& control) {
  const run_setup setup(config);
  const auto& data = data_of(config, *setup.equation);
  if (config.model.name != "broadwell" || data.jumps.size() != 1)
    throw input_error(
        "no Riemann problem of the Broadwell model (the data need exactly one jump); choose riemann-1 or 2");
  const auto state_at = [&](double x) {
    std::vector<double> f(3);
    data.point_value({x}, f);
    double omega[2];
    relaxation_of(setup).moments(f.data(), omega);
    return broadwell_riemann::state{omega[0], omega[1]};
  };
  const broadwell_riemann exact(state_at(config.space.domain[0][0]), state_at(config.space.domain[0][1]));
  const outcome run = compute_limit(config, control);

  riemann_comparison result;
  result.x = run.fields.x;
  double size = 0.0;
  for (int i = 0; i < run.cells; ++i) {
    const double* f = run.state.data() + static_cast<std::ptrdiff_t>(i) * run.components;
    double omega[2];
    relaxation_of(setup).moments(f, omega);
    broadwell_riemann::state mean{0.0, 0.0};
    constexpr int points = 50;  // midpoints: their error at a shock is 1/100 of that of one cell
    for (int q = 0; q < points; ++q) {
      const double x = result.x[static_cast<std::size_t>(i)] + run.cell_volume * ((q + 0.5) / points - 0.5);
      const auto there = exact.at((x - data.jumps[0]) / config.time.end);
      mean.rho += there.rho / points;
      mean.m += there.m / points;
    }
    result.rho.push_back(omega[0]);
    result.m.push_back(omega[1]);
    result.rho_exact.push_back(mean.rho);
    result.m_exact.push_back(mean.m);
    result.error += std::abs(omega[0] - mean.rho) + std::abs(omega[1] - mean.m);
    size += std::abs(mean.rho) + std::abs(mean.m);
  }
  result.error /= size;
  return result;
}

}  // namespace apsis::paper
