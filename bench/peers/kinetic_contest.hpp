#pragma once

#include "contest.hpp"
#include "kinetic_task.hpp"

#include <string>
#include <vector>

namespace apsis::bench::peers {

/// Tolerances of SUNDIALS: every rtol with every atol = share · rtol.
struct ladder {
  std::vector<double> rtol, atol_by_rtol;
};

/// Settings that the contestants may choose from.
struct kinetic_settings {
  std::vector<double> factors;     ///< equal steps of Apsis, in multiples of r Δt_FE, or of Δt_FE for methods
                                   ///< without an SSP coefficient
  std::vector<double> tolerances;  ///< of steps of Apsis
  ladder fine,                     ///< of SUNDIALS, tuned
      few,                         ///< with Krylov iterations or constraints
      defaults;                    ///< with its defaults
  ladder implicit;                 ///< of Radau, whose Newton matrices couple all unknowns
  double longest;  ///< step limit of T as the explicit part of ARKODE, which error control alone finds
                   ///< only through failed steps
  std::vector<std::string> explicit_methods;
  std::vector<long> explicit_steps;                  ///< numbers of equal steps of these
  double seconds_ours = 5.0, seconds_others = 10.0;  ///< time limit of a run
};

/// Enters every IMEX method of the catalogue and extrapolated Euler steps, with equal steps and by
/// tolerance, ARKODE, CVODE, Radau and explicit methods. The task must outlive the contest.
void enter_all(contest& all, kinetic_task& task, const kinetic_settings& settings);

/// Enters ARKODE and CVODE with the constraint f ≥ 0 and the explicit methods, with `more`
/// appended to their names.
void enter_constrained_and_explicit(contest& all, kinetic_task& task, const kinetic_settings& settings,
                                    const std::string& more);

/// Returns from, 7/8, 3/4 and 5/8 of it, the same of from/2, … down to `to`; twice as many above 1, where the
/// longest step that keeps f ≥ 0 is found by trial.
std::vector<double> by_octaves(double from, double to);

}  // namespace apsis::bench::peers
