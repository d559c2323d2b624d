#pragma once

#include <apsis/boundary/tensor_axes.hpp>

#include <array>
#include <cstddef>

namespace apsis {

/// Values at mirrored velocities v' = v − 2 (v·n) n of a wall with the normal n, by linear interpolation
/// along each axis. Velocities v' beyond the ends of an axis are shortened to them: v'·n keeps its sign.
/// `inward` is v·n of every velocity. Dimensionless.
namespace mirrored_interpolation {

/// values[j] ← Σ ω_p from[p] / Σ ω_p for every velocity with v_j·n > 0, with the weights ω of the corners p
/// of the cell around v'_j that have v_p·n < 0. It is 0 without such corners. from[] is 0 where v·n ≥ 0, and
/// does not overlap values[]. Results are ≥ 0 if from[] is.
void gather(const tensor_axes& axes, const std::array<double, 3>& normal, const double* inward,
            std::size_t sets, const double* from, double* values);
/// Sets values[j] of velocities with v_j·n > 0 such that the flux Σ w v·n values is that of `arriving` ≥ 0
/// with v·n < 0: each v_p·n < 0 gives its flux to the nearest corner around v'_p. `weights`: w.
void deposit(const tensor_axes& axes, const std::array<double, 3>& normal, const double* inward,
             const double* weights, const double* arriving, double* values);

}  // namespace mirrored_interpolation

}  // namespace apsis
