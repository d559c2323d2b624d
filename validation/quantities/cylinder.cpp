#include <apsis/run/body_loads.hpp>
#include <apsis/run/setup.hpp>

#include <cmath>
#include <string>

#include <fmt/format.h>
#include <validation/quantity.hpp>

namespace apsis::validation {
namespace cylinder_quantity {
namespace {

double compute(const quantity_values& parameters, const quantity_run& make) {
  const double mach = number_between(parameters, "mach", 0.5, 8.0);
  const std::string& quantity = one_of(parameters, "quantity", {"drag", "heat"});
  const double U = mach * std::sqrt(5.0 / 3.0);
  // Free molecules do not come back: the stream may begin close to the wall.
  const simulation run = make(
      "gas/cylinder", {"parameters.M=" + parameters.at("mach"), "parameters.Kn=1e9", "space.cells=[32,16]",
                       "space.domain=[[-1.3,1.3],[0,1.3]]", fmt::format("velocity.max={}", U + 4.4),
                       "velocity.points=32", "time.method=md-imex-5-2", "time.end=2.5", "output.every=0"});
  const std::string wanted = quantity == "drag" ? "C_D" : "C_H";
  for (const load_value& one :
       loads_in_stream(body_loads(run.setup(), run.last()).front(), *run.config().output.reference))
    if (one.name == wanted) return one.value;
  throw input_error("the case gas/cylinder has no " + wanted);
}

}  // namespace
}  // namespace cylinder_quantity

extern const quantity_entry quantity_cylinder;
const quantity_entry quantity_cylinder = {
    .name = "cylinder",
    .description =
        "drag or heat coefficient of a circular cylinder in a stream of free molecules, diffuse wall of the "
        "temperature of the stream, over the diameter",
    .source =
        "free-molecular flow past a cylinder: C_D = (sqrt(pi)/s) exp(-h) ((s^2 + 3/2) I_0(h) + (s^2 + 1/2) "
        "I_1(h)) + pi^(3/2)/(4 s), h = s^2/2, s = mach sqrt(5/6)",
    .parameters = {{"mach", "2", "Mach number of the stream, 0.5 to 8"},
                   {"quantity", "drag", "drag or heat"}},
    .references = {theory({{"mach", "1"}}, 5.005983, 1.5e-3), theory({{"mach", "2"}}, 3.193721, 1.5e-3),
                   theory({{"mach", "5"}}, 2.376552, 1.5e-3),
                   theory({{"mach", "2"}, {"quantity", "heat"}}, 1.215623, 1.5e-3)},
    .compute = cylinder_quantity::compute};

}  // namespace apsis::validation
