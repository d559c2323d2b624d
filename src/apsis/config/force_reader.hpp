#pragma once

#include <apsis/config/case.hpp>
#include <apsis/model/acceleration.hpp>
#include <apsis/model/model.hpp>

#include <optional>

namespace apsis {

/// Returns the acceleration of the table [force], bounded by its largest values at the cell centres: exactly
/// where it does not depend on t, otherwise from samples of [0, time.end] with a margin of one percent.
/// Throws input_error at the place of a formula: more of them than velocity dimensions, or a value that is
/// not finite.
std::optional<acceleration> make_acceleration(const case_config& config, const model& equation);

}  // namespace apsis
