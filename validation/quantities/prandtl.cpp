#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>
#include <validation/quantity.hpp>

namespace apsis::validation {
namespace prandtl_quantity {
namespace {

double field_at(const field_table& fields, const std::string& name, std::size_t cell) {
  const auto found = std::find(fields.names.begin(), fields.names.end(), name);
  if (found == fields.names.end()) throw std::out_of_range("the run has no field '" + name + "'");
  return fields.values[static_cast<std::size_t>(found - fields.names.begin())][cell];
}

/// Computes Pr = (5/2) μ (−T_x)/q with μ = ε T^s in a gas between plates of different temperature, far
/// from both.
double compute(const quantity_values& parameters, const quantity_run& make) {
  const double delta = positive_number(parameters, "delta");
  const simulation run = make(
      "gas/fourier", {"parameters.delta=" + parameters.at("delta"), "model.name=" + parameters.at("model"),
                      steady_state, "output.fields=[\"T\", \"heat_flux\"]"});
  const field_table fields = run.fields();
  const std::size_t middle = fields.x.size() / 2;
  double slope = 0.0, heat = 0.0, T = 0.0;
  // Slope and means are from two cells on either side of the middle.
  slope = (field_at(fields, "T", middle + 1) - field_at(fields, "T", middle - 2)) /
          (fields.x[middle + 1] - fields.x[middle - 2]);
  for (std::size_t cell = middle - 2; cell < middle + 2; ++cell) {
    heat += 0.25 * field_at(fields, "heat_flux", cell);
    T += 0.25 * field_at(fields, "T", cell);
  }
  const double epsilon = 1.0 / (std::sqrt(2.0) * delta);
  const double viscosity = epsilon * std::pow(T, run.config().model.parameters.at("viscosity_exponent"));
  return 2.5 * viscosity * -slope / heat;
}

}  // namespace
}  // namespace prandtl_quantity

extern const quantity_entry quantity_prandtl;
const quantity_entry quantity_prandtl = {
    .name = "prandtl",
    .description =
        "Prandtl number from temperature gradient and heat flux between plates, small Knudsen number",
    .source = "the Chapman-Enskog limit of each model",
    .parameters = {{"delta", "50", "rarefaction p L/(mu v0), v0 = sqrt(2 R T)"},
                   {"model", "shakhov", "bgk, shakhov or es-bgk"}},
    .references = {theory({{"model", "bgk"}}, 1.0), theory({{"model", "shakhov"}}, 2.0 / 3.0),
                   theory({{"model", "es-bgk"}}, 2.0 / 3.0)},
    .compute = prandtl_quantity::compute};

}  // namespace apsis::validation
