#include <apsis/model/velocity_support.hpp>

#include <apsis/model/gas_model.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>

#include <fmt/format.h>

namespace apsis {
namespace {

constexpr double unlimited = std::numeric_limits<double>::infinity();

struct ends {
  double lower, upper;
};

ends ends_of(const velocity_line& line) {
  return {line.v().front() - 0.5 * line.weights().front(), line.v().back() + 0.5 * line.weights().back()};
}

/// Shares of the mass and energy of a normal distribution beyond κ standard deviations.
struct tail {
  double mass, energy;
};

tail tail_beyond(double kappa) {
  const double mass = 0.5 * std::erfc(kappa / std::numbers::sqrt2);
  const double height = std::exp(-0.5 * kappa * kappa) / std::sqrt(2.0 * std::numbers::pi);
  return {mass, mass + kappa * height};
}

/// Returns the largest defect of the sums for mass, mean and energy.
double missed_by(const velocity_line& line, double u, double width) {
  double mass = 0.0, mean = 0.0, energy = 0.0;
  for (std::size_t j = 0; j < line.v().size(); ++j) {
    const double c = (line.v()[j] - u) / width;
    const double part = line.weights()[j] / width * std::exp(-0.5 * c * c);
    mass += part;
    mean += part * c;
    energy += part * c * c;
  }
  const double norm = 1.0 / std::sqrt(2.0 * std::numbers::pi);
  return std::max({std::abs(norm * mass - 1.0), std::abs(norm * mean), std::abs(norm * energy - 1.0)});
}

/// Returns a number rounded up to three digits.
std::string at_least(double x) {
  const double unit = std::pow(10.0, std::floor(std::log10(x)) - 2.0);
  return fmt::format("{:.4g}", std::ceil(x / unit * (1.0 - 1e-12)) * unit);
}

/// Returns a number, followed by its value in SI units if there are scales.
std::string with_unit(const std::string& number, double value, const dimension& measure,
                      const gas_scales* scales) {
  return scales == nullptr
             ? number
             : fmt::format("{} [{:.4g} {}]", number, value * scales->unit(measure), unit_of(measure));
}

/// Returns the largest defect of the sums over rings, for both directions across the axis.
double missed_on_rings(const velocity_grid& grid, const fluid_state& state) {
  const double width = std::sqrt(state.T), norm = 1.0 / (2.0 * std::numbers::pi * state.T);
  double mass = 0.0;
  std::array<double, 2> mean{}, energy{};
  for (std::size_t l = 0; l < static_cast<std::size_t>(grid.lines()); ++l) {
    std::array<double, 2> c{};
    for (int k = 0; k < 2; ++k)
      c[static_cast<std::size_t>(k)] =
          (grid.component_of_lines(k)[l] - state.u[grid.component_across(k)]) / width;
    const double part = norm * grid.functions_of_lines()[l] * std::exp(-0.5 * (c[0] * c[0] + c[1] * c[1]));
    mass += part;
    for (std::size_t k = 0; k < 2; ++k) {
      mean[k] += part * c[k];
      energy[k] += part * c[k] * c[k];
    }
  }
  return std::max({std::abs(mass - 1.0), std::abs(mean[0]), std::abs(mean[1]), std::abs(energy[0] - 1.0),
                   std::abs(energy[1] - 1.0)});
}

}  // namespace

velocity_support::line velocity_support::line_of(const velocity_line& from) {
  const ends at = ends_of(from);
  line made{at.lower, at.upper, from.v().front(), 0.0, {from.spacing() * from.spacing()}};
  if (from.uniform()) return made;
  const double length = from.v().back() - from.v().front();
  made.set_gaps(4 * from.points(), length,
                [&](double left, double right) { return from.widest_gap(left, right); });
  return made;
}

/// Returns the line of a direction across the axis: velocities along a diameter of the rings.
velocity_support::line velocity_support::line_of(const polar_layout& rings) {
  const double fastest = rings.speeds.back(), angle = 2.0 * std::numbers::pi / rings.angles;
  line made{-fastest, fastest, -fastest, 0.0, {}};
  made.set_gaps(8 * rings.rings, 2.0 * fastest, [&](double left, double right) {
    const double speed = std::max(std::abs(left), std::abs(right));
    const auto above = std::upper_bound(rings.speeds.begin(), rings.speeds.end() - 1, speed);
    const double inner = above == rings.speeds.begin() ? -*above : *(above - 1);
    return std::max(*above - inner, *above * angle);
  });
  return made;
}

velocity_support::velocity_support(const gas& of) : gas_(of) {
  const velocity_grid& grid = of.grid();
  for (int k = 0; k < of.dimensions(); ++k)
    lines_.push_back(is_across(k)                 ? line_of(grid.polar())
                     : k == grid.last_component() ? line_of(grid.last_line())
                                                  : line_of(grid.line(k)));
}

bool velocity_support::is_across(int direction) const {
  return gas_.grid().is_polar() && direction != gas_.grid().last_component();
}

double velocity_support::missed_along(int direction, const fluid_state& state) const {
  const velocity_grid& grid = gas_.grid();
  if (is_across(direction)) return missed_on_rings(grid, state);
  const velocity_line& points = direction == grid.last_component() ? grid.last_line() : grid.line(direction);
  return missed_by(points, state.u[direction], std::sqrt(state.T));
}

double velocity_support::gap_square(const line& of, double u, double T) {
  if (of.gaps.size() == 1) return of.gaps.front();
  const double last = static_cast<double>(of.gaps.size() - 1), width = 2.0 * std::sqrt(T);
  double largest = 0.0;
  for (const double v : {u - width, u, u + width})
    largest = std::max(largest,
                       of.gaps[static_cast<std::size_t>(std::clamp((v - of.first) * of.per_gap, 0.0, last))]);
  return largest;
}

velocity_margins velocity_support::margins(const double* omega) const {
  const double rho = omega[0];
  if (!(rho > 0.0)) return {unlimited, unlimited};
  const double volume = 1.0 / rho;
  double square = 0.0, least = unlimited, gap = 0.0;
  for (std::size_t k = 0; k < lines_.size(); ++k) {
    const double u = omega[1 + k] * volume;
    square += u * u;
    least = std::min({least, u - lines_[k].lower, lines_[k].upper - u});
  }
  const double T = (2.0 * omega[1 + lines_.size()] * volume - square) / gas_.degrees_of_freedom();
  if (!(T > 0.0)) return {unlimited, unlimited};
  for (std::size_t k = 0; k < lines_.size(); ++k)
    gap = std::max(gap, gap_square(lines_[k], omega[1 + k] * volume, T));
  return {least > 0.0 ? least * least / T : 0.0, T / gap};
}

bool velocity_support::is_safe(const velocity_margins& of) {
  return of.room >= safe_room * safe_room && of.resolution >= safe_resolution * safe_resolution &&
         std::isfinite(of.room);
}

velocity_fit velocity_support::fit(const fluid_state& state) const {
  velocity_fit worst;
  const double width = std::sqrt(state.T);
  for (int k = 0; k < gas_.dimensions(); ++k) {
    const auto& own = lines_[static_cast<std::size_t>(k)];
    const double u = state.u[k];
    const tail below = tail_beyond((u - own.lower) / width), above = tail_beyond((own.upper - u) / width);
    worst.beyond = std::max(worst.beyond, std::min(below.mass + above.mass, 1.0));
    const double outside = below.energy + above.energy;
    const double missed = missed_along(k, state);
    if (!(missed > worst.missed)) continue;
    worst.missed = missed;
    worst.direction = k;
    worst.ends = outside >= 0.5 * missed;
  }
  return worst;
}

std::optional<velocity_fit> velocity_support::fit_of_moments(const double* omega, fluid_state& state) const {
  state = gas_.state(omega);
  if (!state.admissible()) return std::nullopt;
  return fit(state);
}

std::optional<velocity_support> support_of(const model& equation) {
  const auto* found = equation.as_gas();
  if (found == nullptr) return std::nullopt;
  return velocity_support(found->molecules());
}

namespace {

std::string of_state(const fluid_state& state, int direction, const gas_scales* scales) {
  constexpr double rounding = 1e-9;  // in thermal speeds
  const double given = state.u[direction], u = std::abs(given) < rounding * std::sqrt(state.T) ? 0.0 : given;
  return fmt::format("u = {}, T = {}", with_unit(fmt::format("{:.3g}", u), u, dimensions::velocity, scales),
                     with_unit(fmt::format("{:.3g}", state.T), state.T, dimensions::temperature, scales));
}

/// Returns the velocities of a direction. For rings it returns those along their axis.
const velocity_line& line_along(const velocity_grid& grid, int direction) {
  return grid.is_polar() ? grid.last_line() : grid.line(direction);
}

/// Returns a message with the share beyond the ends and sufficient velocities.
std::string too_narrow(const gas& of, const fluid_state& state, const velocity_fit& fit,
                       const velocity_words& words) {
  const velocity_line& line = line_along(of.grid(), fit.direction);
  const double needed = std::max(velocity_needed(state.u[fit.direction], state.T), words.needed);
  const std::string value = with_unit(at_least(needed), needed, dimensions::velocity, words.scales);
  const std::string missed = fmt::format("a fraction {:.2g} of the energy of the Maxwellian with {}",
                                         fit.missed, of_state(state, fit.direction, words.scales));
  if (of.grid().is_polar() && fit.direction != of.grid().last_component())
    return fmt::format(
        "velocity.max_across = {:.6g} is too small for {} ({} lies beyond it); give at least {}",
        of.grid().max(fit.direction), words.subject, missed, value);
  if (words.from_file)
    return fmt::format("the velocities end too early for {} ({} lies beyond {:.4g}); give them up to {}",
                       words.subject, missed, line.max(), value);
  if (!line.uniform())
    return fmt::format(
        "velocity.max is too small for {} (the {} velocities up to {:.4g} miss {}); give at "
        "least {}",
        words.subject, line.points(), line.max(), missed, value);
  std::string same_spacing;
  bool equal = !of.grid().is_polar();
  for (int k = 0; k < of.dimensions() && equal; ++k) equal = of.grid().line(k).points() == line.points();
  if (equal)
    same_spacing = fmt::format(", and velocity.points = {:.0f} for the same spacing",
                               std::ceil(line.points() * needed / line.max()));
  return fmt::format(
      "velocity.max = {} is too small for {} ({} lies beyond it); give at least {}{}",
      with_unit(fmt::format("{:.6g}", line.max()), line.max(), dimensions::velocity, words.scales),
      words.subject, missed, value, same_spacing);
}

/// Returns a message with the share that the spacing misses and a sufficient number of velocities.
std::string too_coarse(const gas& of, const fluid_state& state, const velocity_fit& fit,
                       const velocity_words& words) {
  const velocity_line& line = line_along(of.grid(), fit.direction);
  const double width = std::sqrt(state.T);
  if (of.grid().is_polar() && fit.direction != of.grid().last_component())
    return fmt::format(
        "velocity.rings is too small for {} ({} rings of {} velocities miss a fraction {:.2g} of the mass or "
        "the energy of the Maxwellian with {}); give more rings or angles",
        words.subject, of.grid().polar().rings, of.grid().polar().angles, fit.missed,
        of_state(state, fit.direction, words.scales));
  if (line.uniform())
    return fmt::format(
        "velocity.points = {} is too few for {} (the spacing {:.3g} is {:.2g} times the thermal speed "
        "sqrt(T) = "
        "{:.3g}, with {}); give at least {:.0f}",
        line.points(), words.subject, line.spacing(), line.spacing() / width, width,
        of_state(state, fit.direction, words.scales), std::ceil(line.points() * line.spacing() / width));
  return fmt::format(
      "{} too small for {} (the {} velocities miss a fraction {:.2g} of the mass or the energy of the "
      "Maxwellian with {}); give more",
      words.from_file ? "the number of velocities is" : "velocity.points is", words.subject, line.points(),
      fit.missed, of_state(state, fit.direction, words.scales));
}

}  // namespace

unsupported_initial_data velocity_problem(const gas& of, const fluid_state& state, const velocity_fit& fit,
                                          const velocity_words& words) {
  const std::string problem =
      fit.ends ? too_narrow(of, state, fit, words) : too_coarse(of, state, fit, words);
  if (words.from_file) return {"velocity.set", problem};
  const bool of_rings = of.grid().is_polar() && fit.direction != of.grid().last_component();
  return {fit.ends   ? (of_rings ? "velocity.max_across" : "velocity.max")
          : of_rings ? "velocity.rings"
                     : "velocity.points",
          problem};
}

std::string why_beyond_velocities(const model& equation, const double* omega) {
  const auto* found = equation.as_gas();
  if (found == nullptr || !(omega[0] > 0.0)) return "";
  const velocity_grid& grid = found->molecules().grid();
  for (int k = 0; k < grid.dimensions(); ++k) {
    const double u = omega[1 + k] / omega[0];
    if (grid.is_polar() && k != grid.last_component()) {
      const auto& rings = grid.polar().speeds;
      if (std::abs(u) > *(rings.end() - 2))
        return fmt::format("its bulk velocity {:.6g} is at the outermost ring {:.6g} of the velocities", u,
                           rings.back());
      continue;
    }
    const auto& v = line_along(grid, k).v();
    const std::size_t last = v.size() - 1;
    if (!(u > v[last - 1] || u < v[1])) continue;
    const double end = u > 0.0 ? v[last] : v[0];
    return fmt::format("its bulk velocity {:.6g} is at the end {:.6g} of the velocity grid", u, end);
  }
  return "";
}

double velocity_needed(double u, double T) {
  return std::abs(u) + velocity_support::safe_room * std::sqrt(T);
}

}  // namespace apsis
