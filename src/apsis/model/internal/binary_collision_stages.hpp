#pragma once

#include <apsis/model/internal/binary_collisions.hpp>
#include <apsis/model/point_collision.hpp>

#include <memory>

namespace apsis {

/// Returns a solver of stages of the collisions of a gas with discrete velocities, which must outlive it.
///
/// A stage v = u + α Q(v) + β Q̇(v), α = a/ε, β = b/ε², changes v only in the span of the collisions, v = u +
/// Bξ, so that the invariants of v are those of u to rounding. With q = BᵀQ(v) and K = BᵀQ'(v)B, BᵀQ̇ = Kq,
/// and Newton's method solves
///   w₀ ξ − w₁ q/ν + w₂ K q/ν² = 0,   w₀ : w₁ : w₂ = 1 : αν : |β|ν²,   w₀ + w₁ + w₂ = 1,
/// ν being the frequency of collisions, for every ε ≥ 0: as ε → 0 the solution tends to the equilibrium. The
/// exact derivative of Kq is K² + BᵀQ'(Q(v))B, since Q is quadratic. Throws numerical_error where no solution
/// is found.
std::unique_ptr<point_collision> make_binary_collision(const binary_collisions& collisions);

}  // namespace apsis
