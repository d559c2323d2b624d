#include <validation/quantity.hpp>

namespace apsis::validation {

extern const quantity_entry quantity_planted_density;
const quantity_entry quantity_planted_density = {
    .name = "planted-density",
    .description = "mean density between planted walls, dimensionless",
    .source = "the walls let in 1/4 in each of two directions",
    .parameters = {{"epsilon", "0.1", "rate of the exchange"}},
    .references = {theory({}, 0.5, 2e-3)},
    .compute = [](const quantity_values& parameters, const quantity_run& run) {
      return mean_of_field(run("planted/exchange", {"model.epsilon=" + parameters.at("epsilon")}), "rho");
    }};

}  // namespace apsis::validation
