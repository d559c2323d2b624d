#pragma once

#include "measure/table.hpp"
#include "peers/stiff_task.hpp"

#include <memory>
#include <string>

namespace apsis::bench::peers {

/// A problem of the contest.
struct stiff_race {
  std::string title,  ///< title of the table
      problem;        ///< equation, data and reference, in a sentence
  std::unique_ptr<stiff_task> (*make)(double epsilon);
};

/// Measures work and precision for ε = 1, 1e-2, 1e-4, 1e-6 and 1e-10. Contestants are every IMEX method of
/// the catalogue, explicit methods, other integrators of the library, CVODE, ARKODE and Radau. The table has
/// the best of Apsis and a row for each other contestant.
result_table run(const stiff_race& race, const settings& options);

}  // namespace apsis::bench::peers
