#pragma once

#include <apsis/velocity/velocity_line.hpp>

namespace apsis {

/// Returns the error of the momentum of molecules whose directions lie between an axis and an angle φ of a
/// plane, by sums over the product of two lines of velocities: the root of the mean square over all φ of |Σ w
/// v M − ∫ v M dv|, for the Maxwellian M of density 1, velocity 0 and temperature T, in units of √T. A jump
/// of f along a direction of space, such as one that starts at a corner of walls, makes this error times the
/// jump (ray effects: Lathrop, Nucl. Sci. Eng. 32, 1968). Dimensionless.
double ray_error(const velocity_line& first, const velocity_line& second, double T);

}  // namespace apsis
