#include <cmath>

#include <fmt/format.h>
#include <validation/graded_plates.hpp>
#include <validation/quantity.hpp>

namespace apsis::validation {
namespace poiseuille_quantity {
namespace {

/// The flow rate in units of √(2RT) times the relative pressure gradient, which is √2 a.
double flow_rate(const simulation& run, double mean_velocity) {
  return 2.0 * mean_velocity / (std::sqrt(2.0) * run.config().constants.at("a"));
}

/// Cells that are thinner at the plates, where the velocity has the term x log x: the error then is of second
/// order, 2.4e-5 at δ = 10.
double fine_flow(std::vector<std::string> deck, const quantity_run& make) {
  const graded_plates cells(0.05);
  const std::string place = cells.place_formula(), slope = cells.slope_formula();
  deck.push_back(fmt::format("model.epsilon=1/(sqrt(2)*delta*{})", slope));
  deck.push_back(fmt::format("force.acceleration=[0, \"a*{}\"]", slope));
  deck.push_back(fmt::format("initial.u=[0, \"a*sqrt(2)*(delta*{0}*(1 - {0}) + 1)/2\"]", place));
  deck.push_back("space.cells=160");
  deck.push_back("time.steady=2e-9");
  const simulation run = make("gas/poiseuille", deck);
  std::vector<double> flow = field_values(run, "u_y");
  const std::vector<double> x = run.fields().x;
  for (std::size_t i = 0; i < x.size(); ++i) flow[i] *= cells.slope(x[i]);
  return flow_rate(run, mean_of_cells(flow, run.fields().shape));
}

double default_flow(std::vector<std::string> deck, double delta, const quantity_run& make) {
  // The profile of a dense gas is a parabola with thin layers at the plates.
  deck.push_back(delta > 20.0 ? "space.cells=80" : "space.cells=40");
  const simulation run = make("gas/poiseuille", deck);
  return flow_rate(run, mean_of_field(run, "u_y"));
}

double compute(const quantity_values& parameters, const quantity_run& make) {
  const double delta = positive_number(parameters, "delta");
  const bool fine = one_of(parameters, "deck", {"default", "fine"}) == "fine";
  // The velocity, about aδ/4, is small, so that terms of second order are below the accuracy.
  const double a = 0.002 / (1.0 + 0.5 * delta);
  const std::vector<std::string> deck = {
      "parameters.delta=" + parameters.at("delta"), fmt::format("parameters.a={}", a),
      "model.name=" + parameters.at("model"), fmt::format("time.safety={}", steady_safety(delta)),
      "output.fields=[\"u_y\"]"};
  return fine ? fine_flow(deck, make) : default_flow(deck, delta, make);
}

}  // namespace
}  // namespace poiseuille_quantity

extern const quantity_entry quantity_poiseuille;
const quantity_entry quantity_poiseuille = {
    .name = "poiseuille",
    .description = "flow rate G = 2 (integral of u) between plates, linear, diffuse walls",
    .source = "Cercignani, Daneri, J. Appl. Phys. 34 (1963); Loyalka, Petrellis, Storvick (1975); BGK",
    .parameters = {{"delta", "1", "rarefaction p L/(mu v0), v0 = sqrt(2 R T)"},
                   {"model", "bgk", "bgk, shakhov or es-bgk"},
                   {"deck", "default", "default or fine (docs/validation.md)"}},
    .references = {published({{"delta", "0.01"}}, 3.049650), published({{"delta", "0.1"}}, 2.032714),
                   published({{"delta", "1"}}, 1.538678), published({{"delta", "10"}}, 2.768644),
                   published({{"delta", "100"}}, 17.691059)},
    .compute = poiseuille_quantity::compute};

}  // namespace apsis::validation
