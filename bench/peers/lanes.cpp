// This file is compiled for the processor of the machine, so that lanes are vectors of this processor.
#include "ensembles.hpp"

#include <apsis/integrate/ensemble.hpp>

namespace apsis::bench::peers {
namespace {

component_tolerances<double> tolerances_of(const ensemble_task& task, double rtol) {
  std::vector<double> absolute = task.sizes;
  for (double& size : absolute) size *= rtol;
  return {{rtol}, absolute};
}

/// Integrates an ensemble by linearly implicit steps, or by a method of the catalogue.
template <std::size_t N, std::size_t Parameters, class F, class G>
void integrate_by(const ensemble_task& task, const std::string& method, double rtol, const F& f, const G& g,
                  std::span<double> u, std::span<const double> parameters) {
  const auto tolerances = tolerances_of(task, rtol);
  if (method == linear_steps)
    integrate_ensemble<N, Parameters>(linearly_implicit{}, f, g, u, parameters, 0.0, task.t1, tolerances);
  else
    integrate_ensemble<N, Parameters>(find_method(method), f, g, u, parameters, 0.0, task.t1, tolerances);
}

}  // namespace

void robertson_in_lanes(const ensemble_task& task, const std::string& method, double rtol,
                        std::span<double> u, std::span<const double> parameters) {
  const auto rate = [](double, auto y, auto k, auto f) {
    f[0] = k[1] * y[1] * y[2] - k[0] * y[0];
    f[2] = k[2] * y[1] * y[1];
    f[1] = -f[0] - f[2];
  };
  integrate_by<3, 3>(task, method, rtol, no_lane_transport{}, rate, u, parameters);
}

void ode_model_in_lanes(const ensemble_task& task, const std::string& method, double rtol,
                        std::span<double> u, std::span<const double> parameters) {
  const auto transport = [](double, auto y, auto, auto f) {
    f[0] = y[1];
    f[1] = 0.0;
  };
  const auto rate = [](double, auto y, auto epsilon, auto f) {
    f[0] = 0.0;
    f[1] = (y[0] * y[0] + 1.0) * (sin(y[0]) - y[1]) / epsilon[0];
  };
  integrate_by<2, 1>(task, method, rtol, transport, rate, u, parameters);
}

}  // namespace apsis::bench::peers
