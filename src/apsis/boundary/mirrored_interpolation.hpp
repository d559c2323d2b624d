#pragma once

#include <apsis/boundary/tensor_axes.hpp>

#include <array>
#include <cstddef>

namespace apsis {

/// Values at mirrored velocities v' = v − 2 (v·n) n at a wall with the normal n, by linear interpolation
/// along each axis. A velocity v' beyond the end of an axis is shortened to this end without a change of its
/// direction. `inward` is v·n of every velocity. Dimensionless.
namespace mirrored_interpolation {

/// values[j] ← Σ ω_p from[p] / Σ ω_p for every velocity with v_j·n > 0, in each of `sets` sets. The sums are
/// over the corners p of the cell around v'_j with v_p·n < 0, and ω are their interpolation weights.
/// values[j] is 0 if there is no such corner. from[] is 0 where v·n ≥ 0, and does not overlap values[].
/// Results are ≥ 0 if from[] is.
void gather(const tensor_axes& axes, const std::array<double, 3>& normal, const double* inward,
            std::size_t sets, const double* from, double* values);
/// Sets values[j] for velocities with v_j·n > 0 such that their flux Σ w |v·n| values is that of `arriving` ≥
/// 0. Each velocity with v_p·n < 0 gives its flux to the nearest leaving corner around v'_p. If there is no
/// such corner, the velocity with the largest w v·n receives the flux. `weights` are w.
void deposit(const tensor_axes& axes, const std::array<double, 3>& normal, const double* inward,
             const double* weights, const double* arriving, double* values);

}  // namespace mirrored_interpolation

}  // namespace apsis
