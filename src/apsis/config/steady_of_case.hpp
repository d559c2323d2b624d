#pragma once

#include <apsis/config/case.hpp>
#include <apsis/model/model.hpp>

namespace apsis {

/// Throws input_error, at the key that is the cause, if a case cannot have a table [steady]: its model does
/// not relax to an equilibrium, or a boundary, a solid box, a force or a source depends on t.
void check_steady(const case_config& config, const model& equation);

}  // namespace apsis
