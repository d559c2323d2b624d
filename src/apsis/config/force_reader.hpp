#pragma once

#include <apsis/config/case.hpp>
#include <apsis/model/acceleration.hpp>
#include <apsis/model/model.hpp>

#include <optional>

namespace apsis {

/// Returns the acceleration of the table [force] with bounds of its components; nothing without the table.
/// The bounds are exact for constants. Otherwise they are the largest values at the cell centres, in samples
/// of [0, time.end], with a margin of one percent. Throws input_error at the place of a formula if there are
/// more formulas than velocity dimensions, or if a value is not finite. Throws it at the key of the
/// velocities if they are too few or unevenly spaced along a direction of the force.
std::optional<acceleration> make_acceleration(const case_config& config, const model& equation);

}  // namespace apsis
