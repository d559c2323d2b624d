#include "kinetic_flow.hpp"

#include <apsis/core/errors.hpp>
#include <apsis/core/relaxation_flow.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace apsis::bench::peers {

kinetic_flow::kinetic_flow(semidiscrete_problem& problem, const relaxation_model& equation,
                           const std::vector<double>& rates)
    : problem_(problem),
      equation_(equation),
      rates_(rates),
      omega_(static_cast<std::size_t>(batch * equation.moment_count())),
      equilibria_(batch, equation.components()) {}

void kinetic_flow::advance_collision(double, double s, field& u) {
  for (int first = 0; first < u.cells(); first += batch) {
    const int count = std::min(batch, u.cells() - first);
    equation_.moments_of_rows(u.row(first), u.stride(), count, omega_.data());
    if (const int done = equation_.equilibria(omega_.data(), count, equilibria_.row(0), u.stride());
        done < count)
      throw numerical_error("no local equilibrium (the moments are not admissible); reduce the time step",
                            {-1, std::nan(""), first + done, 0.0});
    for (int row = 0; row < count; ++row) {
      const double rate = equation_.rate(omega_.data() + row * equation_.moment_count()) *
                          rates_[static_cast<std::size_t>(first + row)];
      const auto weights = flow_weights(s, rate, 1.0);
      double* f = u.row(first + row);
      const double* e = equilibria_.row(row);
      const int width = u.stride();
#pragma omp simd
      for (int k = 0; k < width; ++k) f[k] = weights.of_u * f[k] + weights.of_e * e[k];
    }
  }
}

}  // namespace apsis::bench::peers
