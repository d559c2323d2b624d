#pragma once

#include <apsis/config/case.hpp>
#include <apsis/model/model.hpp>

namespace apsis {

/// Throws input_error if a case cannot have a table [steady], at the key that is the cause. The model must
/// relax to an equilibrium; boundaries, solids, force and source must not depend on t.
void check_steady(const case_config& config, const model& equation);

}  // namespace apsis
