#pragma once

namespace apsis {

/// Outer nodes ±√(3/5)/2 of the three-point Gauss–Legendre rule on [−½, ½].
inline constexpr double gauss3_outer = 0.38729833462074168852;

/// Interior nodes ±1/(2√5) of the four-point Gauss–Lobatto rule on [−½, ½].
inline constexpr double lobatto4_inner = 0.22360679774997896964;

}  // namespace apsis
