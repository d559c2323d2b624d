#pragma once

#include "peers/contest.hpp"
#include "peers/kinetic_task.hpp"

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
  std::vector<double> tolerances;  ///< tolerances of steps of Apsis
  ladder fine,                     ///< tolerances of SUNDIALS, tuned
      few,                         ///< of ARKODE with Krylov iterations
      defaults;                    ///< of SUNDIALS with its defaults
  ladder implicit;                 ///< tolerances of Radau, whose Newton matrices couple all unknowns
  double longest;  ///< step limit of ARKODE with an explicit T; error control alone finds this limit only
                   ///< through failed steps
  std::vector<std::string> explicit_methods;
  std::vector<long> explicit_steps;                  ///< numbers of equal steps of the explicit methods
  double seconds_ours = 5.0, seconds_others = 10.0;  ///< time limit of a run
};

/// Enters every IMEX method of the catalogue, extrapolated Euler steps, other integrators of the library,
/// ARKODE, CVODE, Radau and explicit methods. Methods take equal steps, and steps by tolerance if they have
/// an embedded solution. The task must outlive the contest.
void enter_all(contest& all, kinetic_task& task, const kinetic_settings& settings);

/// Enters ARKODE and CVODE with the constraint f ≥ 0, and the explicit methods. `more` is appended to
/// their names.
void enter_constrained_and_explicit(contest& all, kinetic_task& task, const kinetic_settings& settings,
                                    const std::string& more);

/// Returns `from` and 7/8, 3/4 and 5/8 of it, then the same of from/2, … down to `to`. Octaves above 1 have
/// twice as many values, because the longest step that preserves f ≥ 0 is found there by trial.
std::vector<double> by_octaves(double from, double to);

}  // namespace apsis::bench::peers
