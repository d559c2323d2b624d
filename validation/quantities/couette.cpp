#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <validation/graded_plates.hpp>
#include <validation/quantity.hpp>

namespace apsis::validation {
namespace couette_quantity {
namespace {

/// The plates move with ±U, so slowly that the problem is linear, because U² is below the accuracy.
constexpr double plate_speed = 0.01;

double compute(const quantity_values& parameters, const quantity_run& make) {
  static_cast<void>(positive_number(parameters, "delta"));
  std::vector<std::string> deck = between_plates(parameters);
  deck.push_back(fmt::format("parameters.U={}", plate_speed));
  const simulation run = make("gas/couette", deck);
  const double stress = 0.5 * (last_flux(run, "right", "momentum_y") - last_flux(run, "left", "momentum_y"));
  // Half Maxwellians with the velocities of the plates have the stress ρ (2U) √(T/(2π)).
  const double free_molecular = 2.0 * plate_speed / std::sqrt(2.0 * std::numbers::pi);
  return stress / free_molecular;
}

}  // namespace
}  // namespace couette_quantity

extern const quantity_entry quantity_couette;
const quantity_entry quantity_couette = {
    .name = "couette",
    .description = "shear stress between moving plates over its free-molecular value, linear, diffuse walls",
    .source = "Willis, Phys. Fluids 5 (1962), and Loyalka; BGK",
    .parameters = {{"delta", "1", "rarefaction p L/(mu v0), v0 = sqrt(2 R T)"},
                   {"model", "bgk", "bgk, shakhov or es-bgk"}},
    .references = {printed(origin::published, {{"delta", "0.01"}}, "0.9914"),
                   printed(origin::published, {{"delta", "0.1"}}, "0.9258"),
                   printed(origin::published, {{"delta", "1"}}, "0.6007"),
                   printed(origin::published, {{"delta", "2"}}, "0.4436"),
                   printed(origin::published, {{"delta", "5"}}, "0.2522"),
                   printed(origin::published, {{"delta", "10"}}, "0.1473"),
                   printed(origin::published, {{"delta", "20"}}, "0.08045"),
                   printed(origin::published, {{"delta", "100"}}, "0.01737")},
    .compute = couette_quantity::compute};

}  // namespace apsis::validation
