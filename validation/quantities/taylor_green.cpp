#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <validation/quantity.hpp>

namespace apsis::validation {
namespace taylor_green_quantity {
namespace {

constexpr double wave_number = 2.0 * std::numbers::pi;

/// Returns the amplitude of sin(kx) cos(ky) in u_x at time t.
double amplitude_at(double t, const std::string& epsilon, const quantity_run& make) {
  // Steps are at most a quarter of ε, because the error of the viscosity grows with Δt/ε.
  const double safety = std::min(1.0, 29.0 * std::stod(epsilon));
  const simulation run =
      make("gas/taylor-green", {"parameters.Kn=" + epsilon, "space.cells=[32,32]", "output.every=0",
                                fmt::format("time.safety={}", safety), fmt::format("time.end={}", t)});
  const std::vector<double> u = field_values(run, "u_x");
  const grid mesh = make_mesh(run.config());
  double sum = 0.0;
  for (std::size_t cell = 0; cell < u.size(); ++cell) {
    const position x = mesh.centre(static_cast<int>(cell));
    sum += u[cell] * std::sin(wave_number * x[0]) * std::cos(wave_number * x[1]);
  }
  return 4.0 * sum / static_cast<double>(u.size());
}

double compute(const quantity_values& parameters, const quantity_run& make) {
  const double epsilon = number_between(parameters, "epsilon", 0.002, 0.03);
  // Both times lie after the transients of the data, which decay like exp(−t/ε).
  constexpr double begin = 0.4, end = 1.0;
  const double decay = std::log(amplitude_at(begin, parameters.at("epsilon"), make) /
                                amplitude_at(end, parameters.at("epsilon"), make)) /
                       (end - begin);
  return decay / (2.0 * wave_number * wave_number * epsilon);
}

}  // namespace
}  // namespace taylor_green_quantity

extern const quantity_entry quantity_taylor_green;
const quantity_entry quantity_taylor_green = {
    .name = "taylor-green",
    .description =
        "decay rate of Taylor-Green vortices over that of the Navier-Stokes equations, 2 k^2 epsilon",
    .source =
        "root s of the dispersion relation of shear waves of the linearized BGK equation with the wave "
        "number K = sqrt(2) k: the integral of M(v)/(1 - s epsilon + i K epsilon v) over v is 1",
    .parameters = {{"epsilon", "0.01", "Knudsen number, 0.002 to 0.03; the viscosity is epsilon"}},
    .references = {theory({{"epsilon", "0.003"}}, 0.99929140), theory({{"epsilon", "0.01"}}, 0.99234128),
                   theory({{"epsilon", "0.03"}}, 0.94306517)},
    .compute = taylor_green_quantity::compute};

}  // namespace apsis::validation
