#include <cmath>

#include <fmt/format.h>
#include <validation/graded_plates.hpp>
#include <validation/quantity.hpp>

namespace apsis::validation {
namespace poiseuille_quantity {
namespace {

double compute(const quantity_values& parameters, const quantity_run& make) {
  const double delta = positive_number(parameters, "delta");
  // The velocity, about a (1 + δ/4), is small, so that terms of second order are below the accuracy.
  const double a = 0.0003 / (1.0 + 0.5 * delta);
  const std::string place = plate_cells.place_formula(), slope = plate_cells.slope_formula();
  std::vector<std::string> deck = between_plates(parameters);
  deck.insert(deck.end(), {fmt::format("parameters.a={}", a), "velocity.points=[96, 20]",
                           "output.fields=[\"u_y\"]", fmt::format("force.acceleration=[0, \"a*{}\"]", slope),
                           fmt::format("initial.u=[0, \"a*sqrt(2)*(delta*{0}*(1 - {0}) + 1)/2\"]", place)});
  const simulation run = make("gas/poiseuille", deck);
  std::vector<double> flow = field_values(run, "u_y");
  const std::vector<double> x = run.fields().x;
  for (std::size_t i = 0; i < x.size(); ++i) flow[i] *= plate_cells.slope(x[i]);
  // The unit is √(2RT) times the relative pressure gradient, which is √2 a.
  return 2.0 * mean_of_cells(flow, run.fields().shape) / (std::sqrt(2.0) * run.config().constants.at("a"));
}

}  // namespace
}  // namespace poiseuille_quantity

extern const quantity_entry quantity_poiseuille;
const quantity_entry quantity_poiseuille = {
    .name = "poiseuille",
    .description = "flow rate G = 2 (integral of u) between plates, linear, diffuse walls",
    .source =
        "Cercignani, Daneri, J. Appl. Phys. 34 (1963); Loyalka, Petrellis, Storvick (1975); delta = 100: "
        "linearized BGK equation, the dense solver of tests/validation/linear_plates.hpp",
    .parameters = {{"delta", "1", "rarefaction p L/(mu v0), v0 = sqrt(2 R T)"},
                   {"model", "bgk", "bgk, shakhov or es-bgk"}},
    .references = {printed(origin::published, {{"delta", "0.01"}}, "3.04965"),
                   printed(origin::published, {{"delta", "0.1"}}, "2.032714"),
                   printed(origin::published, {{"delta", "1"}}, "1.538678"),
                   printed(origin::published, {{"delta", "10"}}, "2.768644"),
                   // The published value 17.691059 is 1.3e-4 below both solvers.
                   printed(origin::computed, {{"delta", "100"}}, "17.69329")},
    .compute = poiseuille_quantity::compute};

}  // namespace apsis::validation
