// Computes a gas on a mesh without a case file: f_t + v f_x = (M[f] − f)/ε(x) on [0, 2]. The initial data are
// a wave in density and temperature.
#include <apsis/integrate/integrate.hpp>
#include <apsis/model/model_registry.hpp>
#include <apsis/scheme/reconstruction_registry.hpp>
#include <apsis/semidiscrete/problem_builder.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

int main() {
  using apsis::position, std::numbers::pi;
  apsis::model_config config = apsis::default_config(apsis::find_model("bgk"));
  config.velocity = {.max = 8.0, .points = 40};
  const auto bgk = apsis::find_model("bgk").make(config);
  const auto v = bgk->velocities().speeds(0);

  apsis::problem_builder builder(*bgk);
  builder.on(apsis::grid::line(40, 0.0, 2.0))
      .with_reconstruction(apsis::find_reconstruction("weno5-z").make())
      .with_positivity_limiter()
      .with_epsilon([](const position& x) { return 1e-4 + 0.1 * std::pow(std::sin(0.5 * pi * x[0]), 2); });
  const auto problem = builder.build();

  apsis::field f = builder.sample([&](const position& x, std::span<double> row) {
    const double rho = 1 + 0.3 * std::sin(pi * x[0]), T = 1 + 0.2 * std::cos(pi * x[0]);
    for (std::size_t j = 0; j < v.size(); ++j)
      row[j] = rho / std::sqrt(2 * pi * T) * std::exp(-v[j] * v[j] / (2 * T));
  });
  const auto mass = [&] {
    double sum = 0, density[3];
    for (int cell = 0; cell < f.cells(); ++cell) {
      bgk->invariant_densities(f.row(cell), density);
      sum += density[0] * builder.mesh().cell_volume();
    }
    return sum;
  };

  const double before = mass();
  apsis::stepper stepper(apsis::find_method("md-imex-6-3"), *problem);
  apsis::integrate(stepper, f, 0.0, 0.2, apsis::step_rule<double>::ssp(1.0));  // Δt = r Δt_FE, whatever ε is
  double least = 1;
  for (int cell = 0; cell < f.cells(); ++cell)
    least = std::min(least, *std::min_element(f.row(cell), f.row(cell) + f.components()));
  std::printf("mass %.12f, changed by less than 1e-13: %s; f >= 0: %s\n", mass(),
              std::abs(mass() - before) < 1e-13 * before ? "yes" : "no", least >= 0 ? "yes" : "no");
}
