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

}  // namespace

void robertson_in_lanes(const ensemble_task& task, const std::string& method, double rtol,
                        std::span<double> u, std::span<const double> parameters) {
  const auto rate = [](double, auto y, auto k, auto f) {
    f[0] = k[1] * y[1] * y[2] - k[0] * y[0];
    f[2] = k[2] * y[1] * y[1];
    f[1] = -f[0] - f[2];
  };
  integrate_ensemble<3, 3>(find_method(method), no_lane_transport{}, rate, u, parameters, 0.0, task.t1,
                           tolerances_of(task, rtol));
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
  integrate_ensemble<2, 1>(find_method(method), transport, rate, u, parameters, 0.0, task.t1,
                           tolerances_of(task, rtol));
}

}  // namespace apsis::bench::peers
