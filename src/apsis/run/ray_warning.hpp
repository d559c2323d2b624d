#pragma once

#include <apsis/run/setup.hpp>

namespace apsis {

/// Warns if the velocities of a gas in two or three space dimensions leave visible rays. Rays appear if
/// walls, boxes or ends emit different gases and molecules cross the domain within the time
/// `relaxation` between collisions. They count as visible if the error of "Rays" in docs/velocities.md
/// exceeds 0.002 of the jump.
void warn_of_rays(const run_setup& setup, double relaxation);

}  // namespace apsis
