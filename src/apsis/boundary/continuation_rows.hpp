#pragma once

#include <array>
#include <span>

namespace apsis {

/// The continuation of a solution beyond a face, for the instruction set of this processor.
namespace continuation_rows {

/// Fills the rows of ghost cells 1, 2, … beyond a face, `width` components each. `inside` are the three cells
/// inside, the nearest one first. The continuation is a parabola through their averages, less steep where
/// they are not smooth.
void fill(const std::array<const double*, 3>& inside, int width, std::span<double* const> ghosts);

/// The same, with a straight line through the nearest two averages for components whose velocity `inward` is
/// positive.
void fill_at_border(const std::array<const double*, 3>& inside, const double* inward, int width,
                    std::span<double* const> ghosts);

}  // namespace continuation_rows
}  // namespace apsis
