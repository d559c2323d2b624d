#pragma once

#include <apsis/model/internal/binary_collisions.hpp>
#include <apsis/model/point_collision.hpp>

#include <memory>

namespace apsis {

/// Returns a solver of stages for `collisions`, which must outlive it. Its functions throw numerical_error if
/// no solution is found.
///
/// A stage v = u + α Q(v) + β Q̇(v), α = a/ε, β = b/ε², changes v only in the span of the collisions: v = u +
/// Bξ. The invariants of v are therefore those of u to rounding. With q = BᵀQ(v) and K = BᵀQ'(v)B, BᵀQ̇ = Kq.
/// Newton's method solves
///   w₀ ξ − w₁ q/ν + w₂ K q/ν² = 0,   w₀ : w₁ : w₂ = 1 : αν : |β|ν²,   w₀ + w₁ + w₂ = 1,
/// where ν is the collision frequency, for every ε ≥ 0. As ε → 0 the solution tends to the equilibrium. The
/// exact derivative of Kq is K² + BᵀQ'(Q(v))B, because Q is quadratic.
std::unique_ptr<point_collision> make_binary_collision(const binary_collisions& collisions);

}  // namespace apsis
