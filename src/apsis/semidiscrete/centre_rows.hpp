#pragma once

namespace apsis {

/// The map between cell averages and values at cell centres, row by row, for the instruction set of this
/// processor. With the second difference δ² of neighbouring cells,
///   ū = M p,  M = I + δ²/24,
/// are the averages of point values p up to O(Δx⁴). All functions take rows of `width` numbers.
namespace centre_rows {

/// Number of neighbours on either side on which a value at a centre depends.
inline constexpr int reach = 6;

/// Rows of cells i = 0 … count−1, one after another: points ← P ū, the values at the centres by the nearest
/// terms of M⁻¹, whose weights decay like ρ^|k|,
///   p_i = ū_i + A Σ_{k=1}^6 ρ^k (ū_{i−k} − 2ū_i + ū_{i+k}),  ρ = √120 − 11 = −0.0455,  A = 24/(22 + 2ρ),
/// so that |I − P M| ≤ 2·10⁻⁹; averages[i] is the row of ū_i, i = −6 … count+5. `limited`: at least half the
/// average, which smooth data that the mesh resolves exceed.
void values(const double* const* averages, int count, bool limited, int width, double* points);

/// Returns whether average + d is negative somewhere.
bool is_negative(const double* average, const double* d, int width);

/// points ← min(points, average) where average + d is negative, or everywhere with `all`.
void lower(const double* average, const double* d, bool all, int width, double* points);

/// Rows of cells i = 0 … count−1, one after another: averages ← u_i + (M d)_i = b_i + F_{i+½} − F_{i−½} with
/// b = u + d and the fluxes F_{i+½} = (d_{i+1} − d_i)/24 between cells; u[i] and d[i] are rows of i = −1 …
/// count. `limited`: no flux takes more than half of b from the cell that it leaves, −b_i/2 ≤
/// F_{i+½} ≤ b_{i+1}/2, so that averages ≥ 0 if b ≥ 0. It enters both cells alike: the sum over all cells
/// does not change.
void add_averages(const double* const* u, const double* const* d, int count, bool limited, int width,
                  double* averages);

/// Operations of values() and add_averages() with limiter for one number of a row (exec/counted.hpp).
double operations();

}  // namespace centre_rows
}  // namespace apsis
