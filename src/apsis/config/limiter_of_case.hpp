#pragma once

#include <apsis/config/case.hpp>

namespace apsis {

/// Returns space.limiter for a case that leaves it out: the limiter where it costs no step and the run can
/// keep f ≥ 0. That is: unknowns of the model are nonnegative and stage solves keep them so, the limiter
/// keeps them so up to Δt_FE = Δx/v_max, and time.method, which is not "auto", has an SSP coefficient.
limiter_choice default_limiter(const case_config& config);

}  // namespace apsis
