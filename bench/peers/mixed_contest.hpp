#pragma once

#include "measure/table.hpp"
#include "mixed.hpp"

#include <vector>

namespace apsis::bench::peers {

/// Work and precision of every IMEX method of the catalogue, SUNDIALS and an explicit method on the
/// mixed-regime problem with these unknowns, for the given temporal errors.
result_table race_on_mixed_regime(unknowns which, const std::vector<double>& errors, const settings& options);

}  // namespace apsis::bench::peers
