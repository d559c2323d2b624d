#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <validation/graded_plates.hpp>
#include <validation/quantity.hpp>

namespace apsis::validation {
namespace kramers_quantity {
namespace {

/// Returns the value at `at` of a function from its values at y_i. It is smooth but for the term y log y of a
/// layer at y = 0.
double interpolated(const std::vector<double>& y, const std::vector<double>& values, double at) {
  const auto singular = [](double s) { return s > 0.0 ? s * std::log(s) : 0.0; };
  if (at < y[1]) {
    const double slope = (values[1] - values[0]) / (singular(y[1]) - singular(y[0]));
    return values[0] + slope * (singular(at) - singular(y[0]));
  }
  std::size_t first = 0;
  while (first + 4 < y.size() && y[first + 2] < at) ++first;
  double sum = 0.0;
  for (std::size_t i = first; i < first + 4; ++i) {
    double weight = 1.0;
    for (std::size_t j = first; j < first + 4; ++j)
      if (j != i) weight *= (at - y[j]) / (y[i] - y[j]);
    sum += weight * values[i];
  }
  return sum;
}

double compute(const quantity_values& parameters, const quantity_run& make) {
  const std::string& value = one_of(parameters, "value", {"slip", "layer"});
  const double distance = number_between(parameters, "distance", 0.0, 5.0);
  // The plates are so far apart that their layers change each other by 1e-6, and so slow that the problem is
  // linear.
  const simulation run =
      make("gas/kramers",
           {"model.name=" + parameters.at("model"), "parameters.delta=28", "parameters.U=0.0003",
            "space.cells=1120", "velocity.points=[48, 16]", steady_state, "output.fields=[\"u_y\"]"});
  const auto& constants = run.config().constants;
  const double U = constants.at("U"), separation = constants.at("delta");
  const graded_plates cells(constants.at("thin"));
  // Far from both plates u' = stress/μ with μ = ε, and u = 0 in the middle. Where this line reaches the
  // velocity of the plate determines the slip. In units of U and μ v₀/p, v₀ = √2, the slope is √2 stress/U.
  const double stress = 0.5 * (last_flux(run, "right", "momentum_y") - last_flux(run, "left", "momentum_y"));
  const double slope = std::numbers::sqrt2 * stress / U;
  const double slip = 1.0 / slope - 0.5 * separation;
  if (value == "slip") return slip;
  std::vector<double> y = run.fields().x, defect = field_values(run, "u_y");
  for (std::size_t i = 0; i < y.size(); ++i) {
    y[i] = separation * cells.place(y[i]);
    defect[i] = y[i] + slip - (1.0 + defect[i] / U) / slope;
  }
  return interpolated(y, defect, distance);
}

}  // namespace
}  // namespace kramers_quantity

extern const quantity_entry quantity_kramers;
const quantity_entry quantity_kramers = {
    .name = "kramers",
    .description =
        "viscous slip s, and layer I(x), of u = k [x + s - I(x)] in a sheared gas at a diffuse wall, "
        "x in units of mu v0/p",
    .source =
        "Albertoni, Cercignani & Gotusso, Phys. Fluids 6 (1963); Loyalka, Petrellis & Storvick, Phys. Fluids "
        "18 (1975); distances 0.3 and 3: linearized BGK equation, "
        "the dense solver of tests/validation/linear_plates.hpp",
    .parameters = {{"distance", "1", "from the wall, in units of mu v0/p, at most 5"},
                   {"value", "slip", "slip or layer"},
                   {"model", "bgk", "bgk, shakhov or es-bgk"}},
    // The accuracy is 1e-5 of the slip.
    .references = {printed(origin::published, {{"value", "slip"}}, "1.01619"),
                   printed(origin::published, {{"value", "layer"}, {"distance", "0"}}, "0.30908", 3e-5),
                   printed(origin::computed, {{"value", "layer"}, {"distance", "0.3"}}, "0.161137", 6e-5),
                   printed(origin::published, {{"value", "layer"}, {"distance", "1"}}, "0.07175", 1.4e-4),
                   printed(origin::computed, {{"value", "layer"}, {"distance", "3"}}, "0.014978", 7e-4)},
    .compute = kramers_quantity::compute};

}  // namespace apsis::validation
