#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <validation/quantity.hpp>

namespace apsis {
namespace {

double compute(const quantity_values& parameters, const quantity_run& make) {
  const double delta = positive_number(parameters, "delta");
  // The velocity, about aδ/4, is small, so that terms of second order are below the accuracy.
  const double a = 0.002 / (1.0 + 0.5 * delta);
  const simulation run = make(
      "gas/poiseuille",
      {"parameters.delta=" + parameters.at("delta"), fmt::format("parameters.a={}", a),
       "model.name=" + parameters.at("model"),
       fmt::format(
           "time.safety={}",
           steady_safety(delta)),  // The profile of a dense gas is a parabola with thin layers at the plates.
       delta > 20.0 ? "space.cells=80" : "space.cells=40", "output.fields=[\"u_y\"]"});
  // Units: √(2RT) times the relative pressure gradient, which is √2 a.
  return 2.0 * mean_of_field(run, "u_y") / (std::sqrt(2.0) * run.config().constants.at("a"));
}

}  // namespace

extern const quantity_entry quantity_poiseuille;
const quantity_entry quantity_poiseuille = {
    .name = "poiseuille",
    .description = "flow rate G = 2 (integral of u) between plates, linear, diffuse walls",
    .source = "Cercignani, Daneri, J. Appl. Phys. 34 (1963); Loyalka, Petrellis, Storvick (1975); BGK",
    .parameters = {{"delta", "1", "rarefaction p L/(mu v0), v0 = sqrt(2 R T)"},
                   {"model", "bgk", "bgk, shakhov or es-bgk"}},
    .published = {{{{"delta", "0.01"}}, 3.049650},
                  {{{"delta", "0.1"}}, 2.032714},
                  {{{"delta", "1"}}, 1.538678},
                  {{{"delta", "10"}}, 2.768644},
                  {{{"delta", "100"}}, 17.691059}},
    .compute = compute};

}  // namespace apsis
