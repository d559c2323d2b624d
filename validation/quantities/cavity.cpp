#include <cmath>
#include <numbers>
#include <string>

#include <fmt/format.h>
#include <validation/quantity.hpp>

namespace apsis::validation {
namespace cavity_quantity {
namespace {

/// The lid moves so slowly that the problem is linear: the square of this is below the accuracy.
constexpr double lid_speed = 0.005;

double compute(const quantity_values& parameters, const quantity_run& make) {
  const double delta = positive_number(parameters, "delta");
  // The distribution of a rare gas jumps at the velocities that come from the ends of the lid. The layers of
  // a dense gas are thin, and its bulk velocity jumps at these ends.
  const bool rare = delta < 0.5, dense = delta > 2.0;
  const int cells = rare ? 24 : dense ? 96 : 48;
  const std::string points = dense ? "[16,22]" : "[32,44]";
  const simulation run = make(
      "gas/cavity", {"parameters.delta=" + parameters.at("delta"), fmt::format("parameters.U={}", lid_speed),
                     "model.name=" + parameters.at("model"), fmt::format("space.cells=[{0},{0}]", cells),
                     "velocity.set=[\"graded\",\"graded\"]", "velocity.points=" + points, steady_state});
  // The molecules that leave the lid have the momentum ρ U √(T/(2π)).
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
    .references = {computed({{"delta", "0.1"}}, 1.20429, 1e-4), computed({{"delta", "1"}}, 1.12509, 1e-4),
                   computed({{"delta", "2"}}, 1.05601, 1e-4), computed({{"delta", "10"}}, 0.74234, 2e-4)},
    .compute = cavity_quantity::compute};

}  // namespace apsis::validation
