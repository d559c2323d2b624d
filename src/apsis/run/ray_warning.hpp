#pragma once

#include <apsis/run/setup.hpp>

namespace apsis {

/// Warns if the velocities of a gas in two or three space dimensions leave rays: walls, boxes or
/// ends emit different gases, molecules cross the domain within the time `relaxation` between collisions,
/// and the error of "Rays" in docs/velocities.md is larger than 0.002 of the jump.
void warn_of_rays(const run_setup& setup, double relaxation);

}  // namespace apsis
