#include <string>

#include <validation/free_stream.hpp>

namespace apsis::validation {
namespace cylinder_quantity {
namespace {

// Free molecules that reach a wall come from the stream alone, so the wall receives integrals of its
// Maxwellian over v_n < 0. With S = s cos of the angle between the normal and the stream, their pressure and
// shear are
//
//     p_i = ρv₀²/(2√π) [S e^(−S²) + √π (1/2 + S²)(1 + erf S)],   τ_i = ρv₀²/(2√π) s_t [e^(−S²) + √π S (1 +
//     erf S)].
//
// A diffuse wall adds the pressure p_w = √(π T_w/2) · flux of molecules. A specular one returns p_i and −τ_i.
// Their forces along the stream are the integrals of p_i cos + τ_i sin + p_w cos and of 2 p_i cos. On a
// circle they are X + Y and 4 X/3, where X = (√π/s) e^(−h) [(s² + 3/2) I₀(h) + (s² + 1/2) I₁(h)] and Y =
// π^(3/2)/(4s). A diffuse wall of the temperature of the stream receives the heat X/2. All are linear in the
// accommodation α, because no molecule hits the body twice. The test free_molecular_bodies integrates the
// fluxes themselves.

double compute(const quantity_values& parameters, const quantity_run& make) {
  // Free molecules do not come back, so that the stream may begin close to the wall.
  return free_stream_coefficient(
      "gas/cylinder",
      {"space.cells=[32,16]", "space.domain=[[-1.3,1.3],[0,1.3]]", "velocity.points=32", "time.end=2.5"},
      parameters, make);
}

}  // namespace
}  // namespace cylinder_quantity

extern const quantity_entry quantity_cylinder;
const quantity_entry quantity_cylinder = {
    .name = "cylinder",
    .description =
        "drag or heat coefficient of a circular cylinder in a stream of free molecules, wall of the "
        "temperature "
        "of the stream, over the diameter",
    .source =
        "free-molecular flow past a cylinder: C_D = (4 - a)/3 X + a pi^(3/2)/(4 s), X = (sqrt(pi)/s) "
        "exp(-h) ((s^2 + 3/2) I_0(h) + (s^2 + 1/2) I_1(h)), C_H = a X/2, h = s^2/2, s = mach "
        "sqrt(5/6), a the accommodation",
    .parameters = free_stream_parameters(),
    .references = {theory({{"mach", "1"}}, 5.005983, 1.5e-3), theory({{"mach", "2"}}, 3.193721, 1.5e-3),
                   theory({{"mach", "5"}}, 2.376552, 1.5e-3),
                   theory({{"mach", "2"}, {"quantity", "heat"}}, 1.215623, 1.5e-3),
                   theory({{"mach", "2"}, {"accommodation", "0.5"}}, 3.217691, 1.5e-3),
                   theory({{"mach", "2"}, {"accommodation", "0"}}, 3.241661, 1.5e-3)},
    .compute = cylinder_quantity::compute};

}  // namespace apsis::validation
