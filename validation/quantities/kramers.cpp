#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <validation/graded_plates.hpp>
#include <validation/quantity.hpp>

namespace apsis {
namespace {

/// Distance of the plates in units of μ v₀/p: the layers change each other by exp(−3 (δ/2)^(2/3)) = 1e-6.
constexpr double separation = 20.0;
/// The velocity has the term x log x at a plate.
constexpr double thinning = 0.03;

std::vector<std::string> deck(const std::string& model) {
  const graded_plates cells(thinning);
  return {fmt::format("parameters.delta={}", separation),
          "parameters.U=0.003",  // U² is below the accuracy
          "model.name=" + model,
          fmt::format("model.epsilon=1/(sqrt(2)*delta*{})", cells.slope_formula()),
          fmt::format("initial.u=[0, \"U*(2*{} - 1)*delta/(delta + 2)\"]", cells.place_formula()),
          "space.cells=140",
          "time.steady=1e-8",
          "output.fields=[\"u_y\"]"};
}

/// Values of a smooth function with the term y log y of a layer at y = 0, from its values at y_i.
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
  const simulation run = make("gas/couette", deck(parameters.at("model")));
  const double U = run.config().constants.at("U");
  // Far from both plates u' = stress/μ with μ = ε, and u = 0 in the middle: the slip is where this line meets
  // the plate. In units of U and μ v₀/p, v₀ = √2, the slope is √2 stress/U.
  const double stress = 0.5 * (last_flux(run, "right", "momentum_y") - last_flux(run, "left", "momentum_y"));
  const double slope = std::numbers::sqrt2 * stress / U;
  const double slip = 1.0 / slope - 0.5 * separation;
  if (value == "slip") return slip;
  std::vector<double> y = run.fields().x, defect = field_values(run, "u_y");
  for (std::size_t i = 0; i < y.size(); ++i) {
    y[i] = separation * graded_plates(thinning).place(y[i]);
    defect[i] = y[i] + slip - (1.0 + defect[i] / U) / slope;
  }
  return interpolated(y, defect, distance);
}

}  // namespace

extern const quantity_entry quantity_kramers;
const quantity_entry quantity_kramers = {
    .name = "kramers",
    .description =
        "viscous slip s, and layer I(x), of u = k [x + s - I(x)] in a sheared gas at a diffuse wall, "
        "x in units of mu v0/p",
    .source =
        "Loyalka, Phys. Fluids 18 (1975), and Siewert; distances 0.3 and 3: linearized BGK equation, "
        "the dense solver of tests/validation/linear_plates.hpp",
    .parameters = {{"distance", "1", "from the wall, in units of mu v0/p, at most 5"},
                   {"value", "slip", "slip or layer"},
                   {"model", "bgk", "bgk, shakhov or es-bgk"}},
    .published = {{{{"value", "slip"}}, 1.01619},
                  {{{"value", "layer"}, {"distance", "0"}}, 0.30908},
                  {{{"value", "layer"}, {"distance", "0.3"}}, 0.16114},
                  {{{"value", "layer"}, {"distance", "1"}}, 0.07175},
                  {{{"value", "layer"}, {"distance", "3"}}, 0.014967}},
    .compute = compute};

}  // namespace apsis
