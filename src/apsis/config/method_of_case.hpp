#pragma once

#include <apsis/config/case.hpp>
#include <apsis/method/method_choice.hpp>

namespace apsis {

/// Returns the data of the case that determine the choice of a method. CΔt/ε is that of the initial data at
/// up to 64 points, with C = 1 if the data are not in the case.
method_request request_of(const case_config& config);

/// Returns the case with a method in place of time.method = "auto", and the reason in time.method_reason.
/// Returns other cases unchanged. The result is the same on all processes.
case_config with_chosen_method(case_config config);

}  // namespace apsis
