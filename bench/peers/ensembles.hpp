#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace apsis::bench::peers {

/// The name of extrapolated linearly implicit steps, beside those of methods.
inline const std::string linear_steps = "linearly implicit";

/// Many systems of one form with parameters of their own, from t = 0 to t1. Dimensionless.
struct ensemble_task {
  std::string name;
  std::size_t unknowns, parameters;
  double t1;
  std::vector<double> start;  ///< initial values of every system
  std::vector<double> sizes;  ///< sizes of the unknowns: atol_i = rtol · size_i
  /// Returns the parameters of system s, which vary over all systems by some tens of percent.
  std::vector<double> (*parameters_of)(std::size_t s, std::size_t systems);
  /// Integrates all systems in the lanes of Apsis, by a method or by linear_steps.
  void (*in_lanes)(const ensemble_task& task, const std::string& method, double rtol, std::span<double> u,
                   std::span<const double> parameters);
  /// Integrates all systems by CVODE, one after the other, with exact Jacobians and a dense solver. Memory is
  /// allocated once. Returns whether all systems reached t1.
  bool (*by_cvode)(const ensemble_task& task, double rtol, std::span<double> u,
                   std::span<const double> parameters);
};

/// Robertson's reaction to t = 1e11, with its rates as parameters.
ensemble_task robertson_ensemble();
/// The ODE model of the paper to t = 1, with ε as the parameter; T is explicit in lanes.
ensemble_task ode_model_ensemble();

// These functions are compiled for the processor of the machine, as users compile their systems.
void robertson_in_lanes(const ensemble_task& task, const std::string& method, double rtol,
                        std::span<double> u, std::span<const double> parameters);
void ode_model_in_lanes(const ensemble_task& task, const std::string& method, double rtol,
                        std::span<double> u, std::span<const double> parameters);

}  // namespace apsis::bench::peers
