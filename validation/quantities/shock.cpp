#include <apsis/core/errors.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>
#include <validation/quantity.hpp>

namespace apsis::validation {
namespace shock_quantity {
namespace {

/// Ratios of density and temperature behind and before a shock at rest in a monatomic gas, and the velocities
/// there (Rankine, Hugoniot).
struct end_states {
  explicit end_states(double mach)
      : density(4.0 * mach * mach / (mach * mach + 3.0)),
        temperature((5.0 * mach * mach - 1.0) * (mach * mach + 3.0) / (16.0 * mach * mach)),
        before(mach * std::sqrt(5.0 / 3.0)),
        behind(before / density) {}
  double density, temperature, before, behind;
};

/// Returns keys for velocities that contain both states and resolve the colder one.
std::vector<std::string> velocities(const end_states& states) {
  const double max =
      std::ceil(std::max(states.before + 6.0, states.behind + 6.0 * std::sqrt(states.temperature)));
  return {fmt::format("velocity.max={}", max), fmt::format("velocity.points={}", 3.0 * max)};
}

simulation make_run(const std::string& name, const quantity_values& parameters, const end_states& states,
                    std::vector<std::string> own, const quantity_run& make) {
  own.push_back("parameters.M=" + parameters.at("mach"));
  own.push_back("model.name=" + parameters.at("model"));
  for (auto& setting : velocities(states)) own.push_back(setting);
  return make(name, own);
}

/// Returns the density behind a shock that moves away from a wall, at a distance from both.
double density_behind(const quantity_values& parameters, const end_states& states, double width,
                      const quantity_run& make) {
  const double length = 3.3 * width;
  const simulation run = make_run(
      "gas/piston", parameters, states,
      {fmt::format("space.domain=[0, {}]", length), fmt::format("time.end={}", 0.6 * length / states.behind)},
      make);
  const std::vector<double> x = run.fields().x, u = field_values(run, "u"), rho = field_values(run, "rho");
  const double half = 0.5 * *std::min_element(u.begin(), u.end());
  const auto front = std::find_if(u.begin(), u.end(), [=](double v) { return v < half; }) - u.begin();
  const auto first = front / 2, last = front * 4 / 5;
  if (last - first < 4)
    throw input_error(
        "there are fewer than 4 cells behind the shock (it has not left the wall); give more space.cells or "
        "a later "
        "time.end");
  return std::accumulate(rho.begin() + first, rho.begin() + last, 0.0) / static_cast<double>(last - first);
}

/// Returns the smallest value over the largest one of a flux through a shock at rest.
double constancy(const std::string& flux, const quantity_values& parameters, const end_states& states,
                 double width, const quantity_run& make) {
  // Fast molecules of the hot gas run far into the stream.
  const double upstream = width + 6.0 * states.before;
  const simulation run = make_run("gas/shock", parameters, states,
                                  {fmt::format("space.domain=[{}, {}]", -upstream, width), "space.cells=300",
                                   fmt::format("time.end={}", 2.0 * width), "time.steady=1e-5"},
                                  make);
  const auto rho = field_values(run, "rho"), u = field_values(run, "u"), T = field_values(run, "T"),
             stress = field_values(run, "stress"), heat = field_values(run, "heat_flux");
  std::vector<double> through;
  for (std::size_t i = 0; i < rho.size(); ++i) {
    const double mass = rho[i] * u[i], normal = rho[i] * T[i] + stress[i];
    through.push_back(flux == "mass" ? mass
                      : flux == "momentum"
                          ? mass * u[i] + normal
                          : u[i] * (0.5 * mass * u[i] + 1.5 * rho[i] * T[i] + normal) + heat[i]);
  }
  const auto [least, most] = std::minmax_element(through.begin(), through.end());
  return *least / *most;
}

double compute(const quantity_values& parameters, const quantity_run& make) {
  const std::string& value = one_of(parameters, "value", {"density", "mass", "momentum", "energy"});
  const double mach = number_between(parameters, "mach", 1.1, 10.0);
  const end_states states(mach);
  // A shock is some mean free paths wide; weaker shocks are wider.
  const double width = 20.0 * (mach + 1.0) / (mach - 1.0);
  return value == "density" ? density_behind(parameters, states, width, make)
                            : constancy(value, parameters, states, width, make);
}

}  // namespace
}  // namespace shock_quantity

extern const quantity_entry quantity_shock;
const quantity_entry quantity_shock = {
    .name = "shock",
    .description =
        "normal shock of a monatomic gas: density behind over density before, and least over largest flux "
        "of mass, momentum and energy through the shock",
    .source = "Rankine and Hugoniot: 4 M^2/(M^2 + 3), and 1 for the fluxes",
    .parameters = {{"mach", "2", "Mach number of the shock, from 1.1 to 10"},
                   {"value", "density", "density, mass, momentum or energy"},
                   {"model", "bgk", "bgk, shakhov or es-bgk"}},
    .references = {theory({{"mach", "1.2"}, {"value", "density"}}, 1.2972973),
                   theory({{"mach", "2"}, {"value", "density"}}, 2.2857143),
                   theory({{"mach", "4"}, {"value", "density"}}, 3.3684211),
                   theory({{"mach", "8"}, {"value", "density"}}, 3.8208955),
                   theory({{"mach", "4"}, {"value", "density"}, {"model", "shakhov"}}, 3.3684211),
                   theory({{"mach", "4"}, {"value", "density"}, {"model", "es-bgk"}}, 3.3684211),
                   theory({{"mach", "1.2"}, {"value", "energy"}}, 1.0),
                   theory({{"mach", "2"}, {"value", "mass"}}, 1.0),
                   theory({{"mach", "2"}, {"value", "momentum"}}, 1.0),
                   theory({{"mach", "2"}, {"value", "energy"}}, 1.0),
                   theory({{"mach", "8"}, {"value", "mass"}}, 1.0),
                   theory({{"mach", "8"}, {"value", "momentum"}}, 1.0),
                   theory({{"mach", "8"}, {"value", "energy"}}, 1.0),
                   theory({{"mach", "8"}, {"value", "energy"}, {"model", "shakhov"}}, 1.0),
                   theory({{"mach", "8"}, {"value", "energy"}, {"model", "es-bgk"}}, 1.0)},
    .compute = shock_quantity::compute};

}  // namespace apsis::validation
