#pragma once

#include <apsis/model/maxwellian.hpp>
#include <apsis/velocity/velocity_grid.hpp>

namespace apsis {

/// m ← ρ (2πT)^{−3/2} exp(−|v − u|²/(2T)) at the points of a grid with rings.
void formula_maxwellian_on_rings(const velocity_grid& grid, const fluid_state& state, double* m);

/// discrete_maxwellian() on a grid with rings: the minimizer exp(α + β·v + γ|v|²) of the entropy with the
/// moments ω. Damped Newton iterations minimize the convex dual (Mieussens, M3AS 10, 2000)
/// D(β, γ) = log Σ w exp(β·c + γ(½|c|² − (3/2)T)), c = v − u. On the boundary of the moments of rows m ≥ 0
/// the iterations approach a limit, in which some values are 0. If they do not reach it, nonnegative_row()
/// computes m instead. The exponentials factor into those along the axis and across it. Returns false if no m
/// ≥ 0 has the moments.
bool discrete_maxwellian_on_rings(const velocity_grid& grid, const double* omega, double* m);

/// Returns the square of the largest distance between neighbouring velocities within a thermal speed √T of u.
double gap_square_on_rings(const velocity_grid& grid, const fluid_state& state);

/// Returns the reason why discrete_maxwellian_on_rings() fails, for messages; "" if it succeeds.
std::string why_unrealizable_on_rings(const velocity_grid& grid, const double* omega);

}  // namespace apsis
