#pragma once

#include <apsis/config/case.hpp>
#include <apsis/config/case_text.hpp>

namespace apsis {

/// Name of the table of reference values.
inline constexpr const char* reference_table = "output.reference";

/// Reads the table [output.reference] of a case with this model, if there is one. Throws input_error at the
/// place of a key that is unknown, missing, of a wrong type or out of range. Throws it at the place of the
/// table for a model that is no gas, for a line, and without solids and output.surfaces.
void read_reference_values(const case_text& text, const model& equation, case_config& config);

}  // namespace apsis
