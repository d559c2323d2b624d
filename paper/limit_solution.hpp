#pragma once

#include <vector>

#include <paper/broadwell_riemann.hpp>
#include <paper/claim.hpp>
#include <paper/fourier_solution.hpp>

namespace apsis::paper {

/// Returns the solution of the written-out limit system (limit_equations) for the initial data of a case,
/// at its end time. The solution must be smooth until then. Throws input_error for a model whose limit is
/// not written.
fourier_solution limit_solution(const case_config& config, int points = 129, int steps = 1000);

/// Runs the production code with ε = 0. Returns the relative L2 distance of ω from that solution, summed over
/// the components of ω. It compares averages or point values, as in the case.
double distance_from_limit_solution(const case_config& config, const fourier_solution& solution,
                                    const study_control& control = {});

/// A run of a Riemann problem of the Broadwell model with ε = 0 and the exact solution of the limit.
struct riemann_comparison {
  std::vector<double> x,          ///< cell centres
      rho,                        ///< density of every cell
      m;                          ///< momentum of every cell
  std::vector<double> rho_exact,  ///< cell averages of the exact density
      m_exact;                    ///< cell averages of the exact momentum
  double error = 0.0;             ///< L1 norm of both differences, over the L1 norm of both exact
};

/// Compares a run with the exact solution. Its states are those at the ends of the domain, and its jump is
/// that of the initial data. Throws input_error for another model, or for data without exactly one jump.
riemann_comparison compare_with_riemann_solution(const case_config& config,
                                                 const study_control& control = {});

}  // namespace apsis::paper
