#pragma once

#include <apsis/method/method.hpp>

namespace apsis {

/// The same method with its long decimals (12 places or more, see decimals()) carried to `digits` places: the
/// nearest solution, in the Euclidean norm of these coefficients, of the order conditions of m.claims.order
/// and of Σ_j p_ij + w_ij = 1 in the rows where the given decimals add up to 1. Rationals, short decimals and
/// zeros are held.
///
/// From order 3 on the conditions of two colours are singular at their solutions, because they imply
/// Σ b̂_i (c_i − ĉ_i)² = 0 with b̂ ≥ 0. So c_i = ĉ_i is imposed at every stage whose T counts, and the
/// conditions that this makes equal to others are left out; the Jacobian then has full rank and Newton's
/// method converges.
///
/// Throws input_error if `digits` is not between 15 and 50, numerical_error if the iteration does not
/// converge.
method polish(const method& m, int digits = 50);

}  // namespace apsis
