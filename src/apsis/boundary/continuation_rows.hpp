#pragma once

#include <array>
#include <span>

namespace apsis {

/// The continuation of a solution beyond a face, for the instruction set of this processor.
namespace continuation_rows {

/// Fills the rows of ghost cells 1, 2, … beyond a face, `width` components each. `inside` are the rows of the
/// three cells inside, the nearest one first. The continuation is a parabola through their averages, which is
/// flattened where the averages are not smooth.
void fill(const std::array<const double*, 3>& inside, int width, std::span<double* const> ghosts);

/// Fills the same rows, but uses a straight line through the nearest two averages for components with a
/// positive velocity `inward`.
void fill_at_border(const std::array<const double*, 3>& inside, const double* inward, int width,
                    std::span<double* const> ghosts);

}  // namespace continuation_rows
}  // namespace apsis
