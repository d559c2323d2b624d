#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <validation/graded_plates.hpp>
#include <validation/quantity.hpp>

namespace apsis::validation {
namespace heat_quantity {
namespace {

/// The temperatures of the plates are 1 ± heat, whose square is below the accuracy.
constexpr double heat = 0.001;

double compute(const quantity_values& parameters, const quantity_run& make) {
  static_cast<void>(positive_number(parameters, "delta"));
  std::vector<std::string> deck = between_plates(parameters);
  deck.push_back(fmt::format("parameters.heat={}", heat));
  const simulation run = make("gas/fourier", deck);
  const double flux = 0.5 * (last_flux(run, "left", "energy") - last_flux(run, "right", "energy"));
  // Half Maxwellians of both temperatures that carry equal masses have the flux ρ √(2T/π) per unit of
  // the difference.
  const double free_molecular = 2.0 * heat * std::sqrt(2.0 / std::numbers::pi);
  return flux / free_molecular;
}

}  // namespace
}  // namespace heat_quantity

extern const quantity_entry quantity_heat;
const quantity_entry quantity_heat = {
    .name = "heat",
    .description = "heat flux between plates over its free-molecular value, linear, diffuse walls",
    .source = "linearized BGK equation, the dense solver of tests/validation/linear_plates.hpp",
    .parameters = {{"delta", "1", "rarefaction p L/(mu v0), v0 = sqrt(2 R T)"},
                   {"model", "bgk", "bgk, shakhov or es-bgk"}},
    .references = {printed(origin::computed, {{"delta", "0.01"}}, "0.992484"),
                   printed(origin::computed, {{"delta", "0.1"}}, "0.935159"),
                   printed(origin::computed, {{"delta", "1"}}, "0.640853"),
                   printed(origin::computed, {{"delta", "10"}}, "0.175788")},
    .compute = heat_quantity::compute};

}  // namespace apsis::validation
