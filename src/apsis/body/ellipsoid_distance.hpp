#pragma once

#include <apsis/velocity/position.hpp>

namespace apsis {

/// Returns a first-order approximation φ of the signed distance of x from an ellipsoid with semi-axes a > 0.
/// The centre is the origin. Only the first `dimensions` components of x and a count:
///   φ = (k − 1) w,  k = |(x_i/a_i)|,  m = |(x_i/a_i²)|.
/// Outside, w = k/m, so that |∇φ| = 1 on the surface. Inside, w = min a + k (k/m − min a). This removes the
/// discontinuity of k/m at the centre, where φ = −min a is the exact distance. φ is exact for a sphere.
double ellipsoid_distance(const position& x, const position& semi_axes, int dimensions);

}  // namespace apsis
