#include <apsis/run/ray_warning.hpp>

#include <apsis/config/emitted_values.hpp>
#include <apsis/core/log.hpp>
#include <apsis/model/velocity_rays.hpp>
#include <apsis/model/velocity_support.hpp>
#include <apsis/velocity/velocity_line_registry.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace apsis {
namespace {

constexpr double visible = 2e-3;  // relative to the jump

/// The gases that walls, boxes and ends emit at t = 0.
struct emission {
  double temperature = 0.0;  ///< lowest temperature
  double jump = 0.0;         ///< largest difference of √T log ρ, of a velocity, or of √T log T
};

std::optional<emission> emission_of(const case_config& config, const model& equation, const gas& molecules) {
  // Extremes of log ρ, log T and the velocity.
  std::array<double, 5> lowest, highest;  // NOLINT(cppcoreguidelines-pro-type-member-init)
  lowest.fill(std::numeric_limits<double>::infinity());
  highest.fill(-std::numeric_limits<double>::infinity());
  bool any = false;
  for (const emitter& one : emitters_of(config)) {
    const emitted_values values(config, equation, one);
    if (!values.any()) continue;
    for (const position& x : one.points) {
      const fluid_state state = values.state(molecules, 0.0, x);
      if (!state.admissible()) continue;  // the boundary itself reports it
      const std::array<double, 5> seen = {std::log(state.rho), std::log(state.T), state.u[0], state.u[1],
                                          state.u[2]};
      for (std::size_t k = 0; k < seen.size(); ++k) {
        lowest[k] = std::min(lowest[k], seen[k]);
        highest[k] = std::max(highest[k], seen[k]);
      }
      any = true;
    }
  }
  if (!any) return std::nullopt;
  emission found{.temperature = std::exp(lowest[1])};
  const double thermal = std::sqrt(found.temperature);
  for (std::size_t k = 0; k < lowest.size(); ++k)
    found.jump = std::max(found.jump, (highest[k] - lowest[k]) * (k < 2 ? thermal : 1.0));
  return found;
}

/// Returns the largest error of all pairs of space dimensions.
double largest_error(const std::vector<velocity_line>& lines, int dimensions, double T) {
  double largest = 0.0;
  for (int k = 1; k < dimensions; ++k)
    for (int i = 0; i < k; ++i)
      largest = std::max(
          largest, ray_error(lines[static_cast<std::size_t>(i)], lines[static_cast<std::size_t>(k)], T));
  return largest;
}

/// Returns the advice to double the points along the directions of space, with the resulting error.
std::string remedy(const case_config& config, int dimensions, int of_velocity, double T) {
  const auto& names = config.velocity.set;
  if (std::any_of(names.begin(), names.end(), is_velocity_file)) return "give more velocities";
  velocity_config more = velocities_of(config);
  std::vector<int> points;
  const std::vector<int> given = more.points.each();
  for (int k = 0; k < of_velocity; ++k) {
    const int n = given.size() == 1 ? given.front() : given[static_cast<std::size_t>(k)];
    points.push_back(k < dimensions ? 2 * n : n);
  }
  more.points = points;
  return fmt::format("velocity.points = [{}] reduce it to {:.1g} %", fmt::join(points, ", "),
                     100.0 * largest_error(make_lines(more, of_velocity), dimensions, T));
}

}  // namespace

void warn_of_rays(const run_setup& setup, double relaxation) {
  const model& equation = *setup.equation;
  const int dimensions = equation.space_dimensions();
  const auto support = support_of(equation);
  // `relaxation` is infinite if nothing relaxes, and for epsilon = 0.
  if (!support || dimensions < 2 || !std::isfinite(relaxation)) return;
  const case_config& config = setup.config();
  // Directions about an axis are the angles of rings. Other errors limit these.
  if (support->molecules().grid().is_polar()) return;
  const auto emitted = emission_of(config, equation, support->molecules());
  if (!emitted || !(emitted->jump > 0.0)) return;
  double shortest = std::numeric_limits<double>::infinity();
  for (const auto& [from, to] : config.space.domain) shortest = std::min(shortest, to - from);
  const double thermal = std::sqrt(emitted->temperature);
  // Part of a jump that collisions leave halfway across the domain.
  const double left = std::exp(-0.5 * shortest / (thermal * relaxation));
  std::vector<velocity_line> lines;
  for (int k = 0; k < dimensions; ++k) lines.push_back(support->molecules().grid().line(k));
  const double error = largest_error(lines, dimensions, emitted->temperature);
  if (!(error * left > visible)) return;
  log::warning(fmt::format(
      "rays leave noise of about {:.1g} in the bulk velocity, {:.1g} % of the largest jump between emitted "
      "gases (few velocity directions and few collisions); {}",
      error * emitted->jump, 100.0 * error,
      remedy(config, dimensions, support->molecules().dimensions(), emitted->temperature)));
}

}  // namespace apsis
