#include <cmath>
#include <numbers>
#include <string>

#include <fmt/format.h>
#include <validation/quantity.hpp>

namespace apsis::validation {
namespace cavity_quantity {
namespace {

/// The lid moves so slowly that the problem is linear: the square of this is below the accuracy.
constexpr double lid_speed = 0.02;

double compute(const quantity_values& parameters, const quantity_run& make) {
  const double delta = positive_number(parameters, "delta");
  // The layers of a dense gas are thin, and its velocity jumps at the ends of the lid.
  const int cells = delta <= 2.0 ? 32 : 48;
  const simulation run = make(
      "gas/cavity", {"parameters.delta=" + parameters.at("delta"), fmt::format("parameters.U={}", lid_speed),
                     "model.name=" + parameters.at("model"), fmt::format("space.cells=[{0},{0}]", cells),
                     "velocity.set=[\"graded\",\"graded\"]", "velocity.points=[16,22]", steady_state});
  // ρ U √(T/(2π)): momentum of the molecules that leave the lid.
  const double emitted = lid_speed / std::sqrt(2.0 * std::numbers::pi);
  return last_flux(run, "top", "momentum_x") / emitted;
}

}  // namespace
}  // namespace cavity_quantity

extern const quantity_entry quantity_cavity;
const quantity_entry quantity_cavity = {
    .name = "cavity",
    .description =
        "shear force on the lid of a square cavity over that of molecules at rest that arrive there, linear, "
        "diffuse walls",
    .source = "linearized BGK equation, the spectral solver of tests/validation/linear_square.hpp",
    .parameters = {{"delta", "1", "rarefaction p L/(mu v0), v0 = sqrt(2 R T)"},
                   {"model", "bgk", "bgk, shakhov or es-bgk"}},
    .references = {computed({{"delta", "0.1"}}, 1.20429, 2e-3), computed({{"delta", "1"}}, 1.12509, 5e-4),
                   computed({{"delta", "2"}}, 1.05601, 5e-4), computed({{"delta", "10"}}, 0.74234, 1e-3)},
    .compute = cavity_quantity::compute};

}  // namespace apsis::validation
