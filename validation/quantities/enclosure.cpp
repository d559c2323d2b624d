#include <cmath>
#include <numbers>
#include <string>

#include <fmt/format.h>
#include <validation/quantity.hpp>

namespace apsis::validation {
namespace enclosure_quantity {
namespace {

double compute(const quantity_values& parameters, const quantity_run& make) {
  const double delta = positive_number(parameters, "delta");
  const double hot = number_between(parameters, "hot", 1.0001, 4.0);
  const std::string& wall = one_of(parameters, "wall", {"bottom", "left", "top"});
  // The distribution of a rare gas jumps at the velocities that come from the ends of the top. The layers of
  // a dense gas are thin.
  const bool rare = delta < 0.5, dense = delta > 2.0;
  const std::string cells = dense ? "[48,96]" : "[20,40]", points = rare    ? "[48,66]"
                                                                    : dense ? "[24,32]"
                                                                            : "[32,44]";
  const simulation run =
      make("gas/enclosure",
           {"parameters.delta=" + parameters.at("delta"), "parameters.hot=" + parameters.at("hot"),
            "model.name=" + parameters.at("model"), fmt::format("velocity.max={}", 6.0 * std::sqrt(hot)),
            steady_state, "space.cells=" + cells, "velocity.points=" + points});
  // Free molecules arrive at and leave all walls at the same rate J. Each wall contributes J √(2π/T) to the
  // density, weighted by the angle that it subtends, on average a quarter of 2π. Its molecules carry 2 T J.
  const double rate = 1.0 / (std::sqrt(2.0 * std::numbers::pi) * (0.25 / std::sqrt(hot) + 0.75));
  const double emitted = 2.0 * (hot - 1.0) * rate;
  // The plane of symmetry cuts bottom and top in half.
  const double length = wall == "left" ? 1.0 : 0.5;
  const double received = last_flux(run, wall, "energy") / (-emitted * length);
  return wall == "top" ? 1.0 + received : received;
}

}  // namespace
}  // namespace enclosure_quantity

extern const quantity_entry quantity_enclosure;
const quantity_entry quantity_enclosure = {
    .name = "enclosure",
    .description =
        "heat that arrives at a wall of a square with a hot top over what free molecules carry away from the "
        "top, diffuse walls",
    .source =
        "view factors (free molecules, any temperature); linearized BGK equation, the spectral solver of "
        "tests/validation/linear_square.hpp",
    .parameters = {{"delta", "1", "rarefaction p L/(mu v0), v0 = sqrt(2 R T)"},
                   {"wall", "bottom", "bottom, left, or top"},
                   {"hot", "1.001", "temperature of the top, 1.0001 to 4; that of the others is 1"},
                   {"model", "bgk", "bgk, shakhov or es-bgk"}},
    .references = {theory({{"delta", "0.0001"}}, std::numbers::sqrt2 - 1.0, 2e-4),
                   theory({{"delta", "0.0001"}, {"wall", "left"}}, 1.0 - 0.5 * std::numbers::sqrt2, 1e-4),
                   theory({{"delta", "0.0001"}, {"hot", "2"}}, std::numbers::sqrt2 - 1.0, 1e-4),
                   computed({{"delta", "1"}}, 0.258184, 1e-4),
                   computed({{"delta", "1"}, {"wall", "left"}}, 0.291405, 1e-4),
                   computed({{"delta", "10"}}, 0.049300, 1e-4),
                   computed({{"delta", "10"}, {"wall", "left"}}, 0.188031, 3e-4)},
    .compute = enclosure_quantity::compute};

}  // namespace apsis::validation
