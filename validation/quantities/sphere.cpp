#include <cmath>
#include <string>

#include <fmt/format.h>
#include <validation/free_stream.hpp>

namespace apsis::validation {
namespace sphere_quantity {
namespace {

// The fluxes are those of quantities/cylinder.cpp. On a sphere p_i cos + τ_i sin and 2 p_i cos have the same
// integral X. The drag of a specular wall is therefore that of a diffuse one without the term of the
// molecules that leave it, 2√π/(3s). A wall of the temperature of the stream receives the heat X/2. The test
// free_molecular_bodies integrates the fluxes themselves.

double compute(const quantity_values& parameters, const quantity_run& make) {
  const double cells = number_between(parameters, "cells", 4.0, 64.0);
  const int velocities = 2 * static_cast<int>(std::ceil(speed_of_stream(parameters) + 4.4));
  // Free molecules do not come back, so that the stream may begin a quarter of a radius from the wall, on
  // all sides.
  const int half = static_cast<int>(std::ceil(1.25 * cells - 1e-9));
  const double end = half / cells;
  if (one_of(parameters, "geometry", {"space", "axisymmetric"}) == "axisymmetric") {
    // Reconstructions along x and r need two cells between the sphere and the boundaries.
    const int wide = static_cast<int>(std::ceil(1.5 * cells - 1e-9));
    return free_stream_coefficient(
        "gas/sphere-axis",
        {fmt::format("space.cells=[{},{}]", 2 * wide, wide),
         fmt::format("space.domain=[[{0},{1}],[0,{1}]]", -wide / cells, wide / cells),
         "boundary.right.kind=inflow", "boundary.right.rho=1", "boundary.right.u=[\"M*sqrt(5/3)\",0,0]",
         "boundary.right.T=1", fmt::format("velocity.points={}", velocities), "velocity.max_across=4.4",
         "time.end=0.8"},
        parameters, make);
  }
  // Incident molecules have their distribution from the start. Only numerical errors near the wall must
  // settle.
  return free_stream_coefficient(
      "gas/sphere",
      {fmt::format("space.cells=[{},{},{}]", 2 * half, half, half),
       fmt::format("space.domain=[[{0},{1}],[0,{1}],[0,{1}]]", -end, end), "boundary.right.kind=inflow",
       "boundary.right.rho=1", "boundary.right.u=[\"M*sqrt(5/3)\",0,0]", "boundary.right.T=1",
       fmt::format("velocity.points={}", velocities), "time.end=0.8"},
      parameters, make);
}

}  // namespace
}  // namespace sphere_quantity

extern const quantity_entry quantity_sphere;
const quantity_entry quantity_sphere = {
    .name = "sphere",
    .description =
        "drag or heat coefficient of a sphere in a stream of free molecules, wall of the temperature of the "
        "stream, over its cross-section",
    .source =
        "free-molecular flow past a sphere: C_D = X + 2 a sqrt(pi)/(3 s), C_H = a X/2, X = (2 s^2 + 1) "
        "exp(-s^2)/(sqrt(pi) s^3) + (4 s^4 + 4 s^2 - 1) erf(s)/(2 s^4), s = mach sqrt(5/6), a the "
        "accommodation",
    .parameters =
        [] {
          auto all = free_stream_parameters();
          all.push_back({"cells", "4", "cells per radius, 4 to 64"});
          all.push_back({"geometry", "space", "space, or axisymmetric: gas/sphere-axis in (x, r)"});
          return all;
        }(),
    .references = {theory({{"mach", "1"}}, 5.110056, 2e-2), theory({{"mach", "5"}}, 2.353731, 2e-2),
                   theory({{"mach", "1"}, {"cells", "8"}}, 5.110056, 5e-3),
                   theory({{"mach", "5"}, {"cells", "8"}}, 2.353731, 5e-3),
                   theory({{"quantity", "heat"}}, 1.277628, 2e-2),
                   theory({{"accommodation", "0"}}, 2.555257, 2e-2),
                   theory({{"mach", "1"}, {"geometry", "axisymmetric"}}, 5.110056, 1e-2),
                   theory({{"mach", "5"}, {"cells", "8"}, {"geometry", "axisymmetric"}}, 2.353731, 5e-3)},
    .compute = sphere_quantity::compute};

}  // namespace apsis::validation
