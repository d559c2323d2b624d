#include <apsis/core/errors.hpp>
#include <apsis/run/body_loads.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <validation/quantity.hpp>

namespace apsis::validation {
namespace coaxial_quantity {
namespace {

/// Speed of the inner wall, and the difference of temperature. The equation of the run is nonlinear.
/// Relative to the value, terms of second order are at most as large as these numbers, and below the error
/// of the mesh.
constexpr double speed = 0.01, heat = 0.002;

// For ρ = T = 1 a mass √(1/2π) arrives per unit of time and area. It leaves with the velocity of the wall, or
// with the additional energy 2 heat.
const double arriving = 2.0 * std::numbers::pi / std::sqrt(2.0 * std::numbers::pi);

/// Computes the value on a line of r, up to a time when transients have decayed. Those of viscosity
/// last 1/(π²ε).
double compute_on_line(const quantity_values& parameters, const quantity_run& make, bool torque, int cells) {
  const double delta = positive_number(parameters, "delta");
  const simulation run = make(
      "gas/annulus",
      {"parameters.delta=" + parameters.at("delta"), fmt::format("parameters.speed={}", torque ? speed : 0.0),
       fmt::format("parameters.heat={}", torque ? 0.0 : heat),
       fmt::format("space.cells=[{}]", std::max(cells / 4, 6)), "space.reconstruction=upwind5",
       "space.limiter=none", fmt::format("time.end={}", 12.0 + 2.0 * delta), "output.every=0"});
  return torque ? last_flux(run, "left", "momentum_y") / (arriving * speed)
                : last_flux(run, "left", "energy") / (arriving * 2.0 * heat);
}

double compute(const quantity_values& parameters, const quantity_run& make) {
  static_cast<void>(positive_number(parameters, "delta"));
  const bool torque = one_of(parameters, "quantity", {"torque", "heat"}) == "torque";
  const double given = number_between(parameters, "cells", 16.0, 512.0);
  const int cells = static_cast<int>(given);
  if (given != cells || cells % 2 != 0)
    throw input_error(fmt::format(
        "cells = {} is not an even number (the axis of the cylinders lies between cells); write cells={}",
        parameters.at("cells").substr(0, 60), 2 * std::lround(given / 2.0)));
  if (one_of(parameters, "geometry", {"plane", "axisymmetric"}) == "axisymmetric")
    return compute_on_line(parameters, make, torque, cells);
  // The mesh has one cell beyond the outer cylinder on each side. Heat is symmetric in both axes, so that a
  // quarter suffices.
  const double end = 2.0 + 4.0 / cells;
  const int half = cells / 2 + 1;
  std::vector<std::string> overrides = {"parameters.delta=" + parameters.at("delta"), "velocity.points=20",
                                        "steady.tolerance=1e-7", "output.every=0"};
  if (torque)
    overrides.insert(overrides.end(), {fmt::format("parameters.speed={}", speed),
                                       fmt::format("space.cells=[{0},{0}]", 2 * half),
                                       fmt::format("space.domain=[[{0},{1}],[{0},{1}]]", -end, end)});
  else
    overrides.insert(overrides.end(), {"parameters.speed=0", fmt::format("parameters.heat={}", heat),
                                       fmt::format("space.cells=[{0},{0}]", half),
                                       fmt::format("space.domain=[[0,{0}],[0,{0}]]", end),
                                       "boundary.left.kind=symmetry", "boundary.bottom.kind=symmetry"});
  const simulation run = make("gas/coaxial", overrides);
  if (!torque) return 4.0 * last_flux(run, "inner", "energy") / (arriving * 2.0 * heat);
  return -body_loads(run.setup(), run.last()).front().torque.front() / (arriving * speed);
}

}  // namespace
}  // namespace coaxial_quantity

extern const quantity_entry quantity_coaxial;
const quantity_entry quantity_coaxial = {
    .name = "coaxial",
    .description =
        "torque that turns, or heat that leaves the inner of two coaxial cylinders of radii 1 and 2, over "
        "the free-molecular value, linear, diffuse walls",
    .source = "linearized BGK equation, the integral equations of tests/validation/linear_annulus.hpp",
    .parameters = {{"delta", "1", "rarefaction p r/(mu v0), r the inner radius, v0 = sqrt(2 R T)"},
                   {"quantity", "torque", "torque or heat"},
                   {"cells", "32", "cells over the outer diameter, 16 to 512, even"},
                   {"geometry", "plane", "plane, or axisymmetric: gas/annulus on a line of r"}},
    .references = {computed({{"delta", "0.1"}}, 0.98830, 2e-2), computed({{"delta", "1"}}, 0.88123, 2e-2),
                   computed({{"delta", "10"}}, 0.35207, 2e-2),
                   computed({{"delta", "10"}, {"cells", "64"}}, 0.35207, 4e-3),
                   computed({{"delta", "0.1"}, {"quantity", "heat"}}, 0.97173, 2e-2),
                   computed({{"delta", "1"}, {"quantity", "heat"}}, 0.77179, 2e-2),
                   computed({{"delta", "10"}, {"quantity", "heat"}}, 0.24738, 2e-2),
                   computed({{"delta", "10"}, {"quantity", "heat"}, {"cells", "64"}}, 0.24738, 4e-3),
                   computed({{"delta", "1"}, {"cells", "64"}, {"geometry", "axisymmetric"}}, 0.88123, 4e-3),
                   computed(
                       {{"delta", "1"}, {"quantity", "heat"}, {"cells", "64"}, {"geometry", "axisymmetric"}},
                       0.77179, 4e-3)},
    .compute = coaxial_quantity::compute};

}  // namespace apsis::validation
