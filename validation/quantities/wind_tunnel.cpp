#include <cmath>
#include <string>

#include <fmt/format.h>
#include <validation/free_stream.hpp>

namespace apsis::validation {
namespace wind_tunnel_quantity {
namespace {

double compute(const quantity_values& parameters, const quantity_run& make) {
  const double mach = number_between(parameters, "mach", 1.5, 6.0);
  static_cast<void>(number_between(parameters, "reynolds", 1.0, 200.0));
  const double cells = number_between(parameters, "cells", 4.0, 32.0);
  const int half = static_cast<int>(std::ceil(2.0 * cells - 1e-9));
  // The gas at rest has the temperature 1 + M²/5 of the wall. Velocities reach 4.9 of its standard
  // deviations. Along the stream they reach further, because the hot gas in the shock still moves with it.
  const double across = 4.9 * std::sqrt(1.0 + mach * mach / 5.0),
               along = across + mach * std::sqrt(1.4) / 5.0;
  const simulation run =
      make("gas/wind-tunnel",
           {"parameters.M=" + parameters.at("mach"), "parameters.Re=" + parameters.at("reynolds"),
            fmt::format("space.cells=[{},{}]", 2 * half, half),
            fmt::format("space.domain=[[{0},{1}],[0,{1}]]", -half / cells, half / cells),
            fmt::format("velocity.max={}", along), fmt::format("velocity.max_across={}", across),
            fmt::format("velocity.points={}", 2 * static_cast<int>(std::ceil(along))),
            fmt::format("time.end={}", 8.0 / mach), "output.every=0"});
  return load_in_stream(run, "C_D");
}

}  // namespace
}  // namespace wind_tunnel_quantity

extern const quantity_entry quantity_wind_tunnel;
const quantity_entry quantity_wind_tunnel = {
    .name = "wind-tunnel",
    .description = "drag coefficient of a sphere of the stagnation temperature in a stream of air",
    .source =
        "P. P. Wegener, H. Ashkenas, J. Fluid Mech. 10 (1961) 550: 1.73 measured at Mach 3.8 to 4.3, "
        "Reynolds number 50",
    .parameters = {{"reynolds", "50", "Reynolds number of the stream over the diameter, 1 to 200"},
                   {"mach", "4", "Mach number of the stream, 1.5 to 6"},
                   {"cells", "5", "cells per radius, 4 to 32"}},
    .references = {published({}, 1.73, 3e-2)},
    .compute = wind_tunnel_quantity::compute};

}  // namespace apsis::validation
