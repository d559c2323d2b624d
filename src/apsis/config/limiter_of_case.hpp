#pragma once

#include <apsis/config/case.hpp>

namespace apsis {

/// Returns space.limiter for a case that omits it: positivity if this costs no steps and the run can keep f ≥
/// 0, otherwise none. The run can keep f ≥ 0 under three conditions:
/// - The unknowns of the model are nonnegative, and stage solves keep them so.
/// - The limiter keeps them so up to Δt_FE = Δx/v_max.
/// - time.method, which is no longer "auto", has an SSP coefficient.
limiter_choice default_limiter(const case_config& config);

}  // namespace apsis
