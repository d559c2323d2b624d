#include <apsis/model/gas_model.hpp>

namespace apsis {

extern const model_entry model_bgk;
const model_entry model_bgk = {
    .name = "bgk",
    .description = "f_t + v f_x = C (M[f] - f)/epsilon on a velocity grid",
    .source = "Bhatnagar, Gross, Krook (1954); Gottlieb, Grant, Hu, Shu, BGK model",
    .has_velocity_grid = true,
    .parameters = gas_model::parameters(0.0),
    .options = gas_model::options(),
    .make = [](const model_config& config) -> std::unique_ptr<model> {
      return std::make_unique<gas_model>(config);
    }};

}  // namespace apsis
