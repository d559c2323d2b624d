#include <apsis/run/setup.hpp>

#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <validation/quantity.hpp>

namespace apsis::validation {
namespace duct_quantity {
namespace {

/// Returns the mean over the cross-section of Σ w v_z (1 − v_⊥²/2) f, minus the heat along the duct that a
/// force carries. By Onsager's relation it is the mass that a temperature gradient carries.
double heat_moment(const simulation& run) {
  const velocity_set& velocities = run.setup().equation->velocities();
  const std::span<const double> v_x = velocities.speeds(0), v_y = velocities.speeds(1),
                                v_z = velocities.speeds(2), w = velocities.weights();
  std::vector<double> of_cells;
  for (int cell = 0; cell < run.mesh().size(); ++cell) {
    const std::span<const double> f = run.row(cell);
    double sum = 0.0;
    for (std::size_t j = 0; j < w.size(); ++j)
      sum += w[j] * v_z[j] * (1.0 - 0.5 * (v_x[j] * v_x[j] + v_y[j] * v_y[j])) * f[j];
    of_cells.push_back(sum);
  }
  return mean_of_cells(of_cells, run.fields().shape);
}

double compute(const quantity_values& parameters, const quantity_run& make) {
  const double delta = positive_number(parameters, "delta");
  const double aspect = number_between(parameters, "aspect", 1.0, 10.0);
  const std::string& value = one_of(parameters, "value", {"flow", "creep"});
  // The Knudsen layers of a dense gas are thin. In a rare gas slow molecules, which take 1/δ to become
  // steady, carry much of the flow.
  const bool rare = delta < 0.5;
  const int cells = rare ? 32 : delta <= 2.0 ? 48 : 64;
  const std::string line = rare ? "\"graded\"" : "\"half-range-gauss-hermite\"";
  const int points = rare ? 24 : delta <= 2.0 ? 16 : 12;
  const simulation run =
      make("gas/duct",
           {"parameters.delta=" + parameters.at("delta"), "parameters.aspect=" + parameters.at("aspect"),
            fmt::format("space.domain=[[0,{}],[0,0.5]]", 0.5 * aspect),
            fmt::format("space.cells=[{},{}]", std::lround(cells * aspect), cells),
            fmt::format("velocity.set=[{0},{0},\"uniform\"]", line),
            fmt::format("velocity.points=[{0},{0},10]", points), steady_state});
  const double moment = value == "flow" ? mean_of_field(run, "u_z") : heat_moment(run);
  return std::sqrt(2.0) * moment / run.config().constants.at("a");
}

}  // namespace
}  // namespace duct_quantity

extern const quantity_entry quantity_duct;
const quantity_entry quantity_duct = {
    .name = "duct",
    .description =
        "flow rate G = 2 (mean of u) along a rectangular duct, driven by a gradient of pressure, or of "
        "temperature (creep), linear, diffuse walls",
    .source = "linearized BGK equation, the spectral solver of tests/validation/linear_duct.hpp",
    .parameters = {{"delta", "1", "rarefaction p L/(mu v0), v0 = sqrt(2 R T), with the shorter side L"},
                   {"value", "flow", "flow or creep"},
                   {"aspect", "1", "longer over shorter side, at most 10"}},
    .references = {computed({{"delta", "0.1"}}, 0.793485, 3e-4), computed({{"delta", "1"}}, 0.767807, 2e-4),
                   computed({{"delta", "5"}}, 0.987212, 2e-4), computed({{"delta", "10"}}, 1.317518, 3e-4),
                   computed({{"delta", "1"}, {"value", "creep"}}, 0.220790, 2e-4),
                   computed({{"delta", "1"}, {"aspect", "2"}}, 1.042655, 4e-4)},
    .compute = duct_quantity::compute};

}  // namespace apsis::validation
