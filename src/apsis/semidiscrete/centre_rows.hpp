#pragma once

namespace apsis {

/// The map between cell averages and values at cell centres, row by row, for the instruction set of this
/// processor. δ² is the second difference of neighbouring cells, and
///   ū = M p,  M = I + δ²/24
/// are the averages of point values p up to O(Δx⁴). All functions take rows of `width` numbers.
namespace centre_rows {

/// Number of neighbours on each side that contribute to a value at a centre.
inline constexpr int reach = 6;

/// points ← P ū for consecutive cells i = 0 … count−1: the values at the centres from the nearest terms of
/// M⁻¹, with weights that decay like ρ^|k|,
///   p_i = ū_i + A Σ_{k=1}^6 ρ^k (ū_{i−k} − 2ū_i + ū_{i+k}),  ρ = √120 − 11 = −0.0455,  A = 24/(22 + 2ρ).
/// Then |I − P M| ≤ 2·10⁻⁹. averages[i] is the row of ū_i, i = −6 … count+5. If `limited`, values are at
/// least half of the average; smooth data that the mesh resolves exceed this bound.
void values(const double* const* averages, int count, bool limited, int width, double* points);

/// Returns true if average + d is negative somewhere.
bool is_negative(const double* average, const double* d, int width);

/// points ← min(points, average) for numbers with a negative average + d, or for all numbers if `all`.
void lower(const double* average, const double* d, bool all, int width, double* points);

/// averages ← u_i + (M d)_i = b_i + F_{i+½} − F_{i−½} for consecutive cells i = 0 … count−1. Here b = u + d,
/// and the fluxes between cells are F_{i+½} = (d_{i+1} − d_i)/24. u[i] and d[i] are rows of i = −1 … count.
/// If `limited`, no flux takes more than half of b from a cell, −b_i/2 ≤ F_{i+½} ≤ b_{i+1}/2. Averages are
/// then nonnegative if b is. The sum over all cells does not change, because a flux enters both of its cells.
void add_averages(const double* const* u, const double* const* d, int count, bool limited, int width,
                  double* averages);

/// Returns the operations of values() and add_averages() with limiter for one number of
/// a row (exec/counted.hpp).
double operations();

}  // namespace centre_rows
}  // namespace apsis
