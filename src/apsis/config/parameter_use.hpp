#pragma once

#include <apsis/config/case_text.hpp>

namespace apsis {

/// Throws input_error at an override of a parameter whose name occurs in no formula of the case. Parameters
/// of the file itself may be unused: a resolved case has the numbers of some formulas.
void check_overridden_parameters(const case_text& text);

}  // namespace apsis
