#include <paper/limit_equations.hpp>

#include <cmath>

namespace apsis::paper {
namespace {

limit_equations ode() {
  return {"u1' = sin u1", 1, {}, [](const double* u, double* s) { s[0] = std::sin(u[0]); }};
}

limit_equations broadwell() {
  return {"limit system of the Broadwell model",
          2,
          [](const double* w, double* flux) {
            flux[0] = w[1];
            flux[1] = (w[0] * w[0] + w[1] * w[1]) / (2.0 * w[0]);
          },
          {}};
}

/// Returns the equation u_t + F(u)_x = 0; nothing if a formula gives the flux, because it is its
/// own description.
std::optional<limit_equations> conservation_law(const case_config& config) {
  const std::string& flux = config.model.options.at("flux");
  if (flux == "burgers")
    return limit_equations{
        "Burgers' equation", 1, [](const double* u, double* f) { f[0] = 0.5 * u[0] * u[0]; }, {}};
  if (flux == "linear")
    return limit_equations{
        "linear advection",
        1,
        [b = config.model.parameters.at("slope")](const double* u, double* f) { f[0] = b * u[0]; },
        {}};
  if (flux == "buckley-leverett")
    return limit_equations{
        "Buckley-Leverett equation",
        1,
        [ratio = config.model.parameters.at("viscosity_ratio")](const double* u, double* f) {
          const double water = u[0] * u[0], oil = (1.0 - u[0]) * (1.0 - u[0]);
          f[0] = water / (water + ratio * oil);
        },
        {}};
  return std::nullopt;
}

/// Returns the Euler equations of a gas with d velocity dimensions, which has d degrees of freedom: γ = (d
/// + 2)/d.
limit_equations euler(int d) {
  return {"compressible Euler equations",
          d + 2,
          [d](const double* w, double* flux) {
            const double u = w[1] / w[0], energy = w[d + 1];
            double kinetic = 0.0;
            for (int k = 1; k <= d; ++k) kinetic += 0.5 * w[k] * w[k] / w[0];
            const double pressure = 2.0 / d * (energy - kinetic);
            flux[0] = w[1];
            for (int k = 1; k <= d; ++k) flux[k] = w[k] * u;
            flux[1] += pressure;
            flux[d + 1] = (energy + pressure) * u;
          },
          {}};
}

}  // namespace

std::optional<limit_equations> written_limit(const case_config& config) {
  if (config.model.name == "ode") return ode();
  if (config.model.name == "broadwell") return broadwell();
  if (config.model.name == "relaxation") return conservation_law(config);
  if (config.model.name == "bgk") {
    const auto& given = config.model.parameters;
    const double dimensions = given.at("velocity_dimensions");
    const auto degrees = given.find("degrees_of_freedom");
    const bool resolved = degrees == given.end() || degrees->second == 0.0 || degrees->second == dimensions;
    return resolved ? std::optional(euler(static_cast<int>(dimensions))) : std::nullopt;
  }
  return std::nullopt;
}

}  // namespace apsis::paper
