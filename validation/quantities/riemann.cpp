#include <apsis/core/errors.hpp>

#include <algorithm>

#include <validation/quantity.hpp>

namespace apsis::validation {
namespace riemann_quantity {
namespace {

/// The states between the waves of a shock tube whose gas moves to the right behind the shock.
struct plateaus {
  double velocity = 0.0, pressure = 0.0, left = 0.0, right = 0.0;
};

double mean_between(const std::vector<double>& x, const std::vector<double>& values, double low,
                    double high) {
  double sum = 0.0, cells = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i)
    if (x[i] > low && x[i] < high) {
      sum += values[i];
      cells += 1.0;
    }
  if (cells < 4.0)
    throw input_error(
        "a plateau between the waves has fewer than 4 cells (waves lie too close); give more space.cells");
  return sum / cells;
}

/// Finds the plateaus without the exact solution. Velocity and pressure are the same on both sides of the
/// contact, which moves with the gas.
plateaus plateaus_of(const simulation& run) {
  const std::vector<double> x = run.fields().x, u = field_values(run, "u"), p = field_values(run, "p"),
                            rho = field_values(run, "rho");
  const double top = *std::max_element(u.begin(), u.end());
  // The rarefaction ends at `start`, and the shock is at `end`.
  double start = x.back(), end = x.front();
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (u[i] > 0.98 * top) start = std::min(start, x[i]);
    if (u[i] > 0.5 * top) end = x[i];
  }
  // The middle half between two waves is clear of both.
  const auto middle = [&](const std::vector<double>& values, double low, double high) {
    return mean_between(x, values, low + 0.25 * (high - low), high - 0.25 * (high - low));
  };
  plateaus out;
  out.velocity = middle(u, start, end);
  out.pressure = middle(p, start, end);
  const double contact = out.velocity * run.t();
  out.left = middle(rho, start, contact);
  out.right = middle(rho, contact, end);
  return out;
}

double compute(const quantity_values& parameters, const quantity_run& make) {
  const std::string& value =
      one_of(parameters, "value", {"velocity", "pressure", "density-left", "density-right"});
  number_between(parameters, "degrees_of_freedom", 1.0, 100.0);
  const plateaus found = plateaus_of(make(
      "gas/sod", {"parameters.kn=1e-8", "model.degrees_of_freedom=" + parameters.at("degrees_of_freedom"),
                  "space.cells=800", "output.fields=[\"rho\", \"u\", \"p\"]"}));
  if (value == "velocity") return found.velocity;
  if (value == "pressure") return found.pressure;
  return value == "density-left" ? found.left : found.right;
}

}  // namespace
}  // namespace riemann_quantity

extern const quantity_entry quantity_riemann;
const quantity_entry quantity_riemann = {
    .name = "riemann",
    .description =
        "states between the waves of Sod's shock tube in the Euler limit: velocity, pressure, density "
        "left and right of the contact",
    .source = "exact solution of the Euler equations, Toro, Riemann Solvers (2009), chapter 4",
    .parameters = {{"degrees_of_freedom", "3", "D of the gas, gamma = (D + 2)/D, from 1 to 100"},
                   {"value", "density-left", "velocity, pressure, density-left or density-right"}},
    .references = {theory({{"degrees_of_freedom", "1"}, {"value", "velocity"}}, 0.60857),
                   theory({{"degrees_of_freedom", "1"}, {"value", "pressure"}}, 0.27291),
                   theory({{"degrees_of_freedom", "1"}, {"value", "density-left"}}, 0.64864),
                   theory({{"degrees_of_freedom", "1"}, {"value", "density-right"}}, 0.17070),
                   theory({{"degrees_of_freedom", "3"}, {"value", "velocity"}}, 0.84119),
                   theory({{"degrees_of_freedom", "3"}, {"value", "pressure"}}, 0.29395),
                   theory({{"degrees_of_freedom", "3"}, {"value", "density-left"}}, 0.47969),
                   theory({{"degrees_of_freedom", "3"}, {"value", "density-right"}}, 0.22981),
                   theory({{"degrees_of_freedom", "5"}, {"value", "velocity"}}, 0.92745),
                   theory({{"degrees_of_freedom", "5"}, {"value", "pressure"}}, 0.30313),
                   theory({{"degrees_of_freedom", "5"}, {"value", "density-left"}}, 0.42632),
                   theory({{"degrees_of_freedom", "5"}, {"value", "density-right"}}, 0.26557)},
    .compute = riemann_quantity::compute};

}  // namespace apsis::validation
