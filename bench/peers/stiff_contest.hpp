#pragma once

#include "measure/table.hpp"
#include "stiff_task.hpp"

#include <functional>
#include <vector>

namespace apsis::bench::peers {

/// Work and precision of every IMEX method of the catalogue, explicit SSP methods, CVODE, ARKODE and Radau on
/// a stiff_task for each ε; `make` returns the task. The table has a row for each of the others and the best
/// of Apsis.
result_table race_on(const std::function<std::unique_ptr<stiff_task>(double)>& make,
                     const std::vector<double>& epsilons, const settings& options);

/// Explanation of the rows and columns of race_on(), to be appended to a description of the problem.
extern const char* const race_note;

}  // namespace apsis::bench::peers
