#pragma once

#include <apsis/velocity/velocity_line.hpp>

namespace apsis {

/// Returns an estimate of ray effects on the product of two lines of velocities (Lathrop, Nucl. Sci. Eng. 32,
/// 1968). Consider the momentum of molecules whose directions in the plane lie between an axis and an angle
/// φ. The result is the root mean square over φ of its error |Σ w v M − ∫ v M dv|, in units of √T. M is the
/// Maxwellian of density 1, velocity 0 and temperature T. A jump of f along a direction of space, which may
/// start at a corner of walls, causes this error times the jump. Dimensionless.
double ray_error(const velocity_line& first, const velocity_line& second, double T);

}  // namespace apsis
