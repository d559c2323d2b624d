#pragma once

#include <apsis/device/device.hpp>

#include <algorithm>
#include <cstddef>

namespace apsis {

/// Lanes of a block in kernels with independent lanes.
inline constexpr int independent_lanes = 128;

/// Returns the size of a launch of independent lanes that together process so many numbers.
inline launch_size launch_for(std::size_t numbers) {
  constexpr std::size_t most_blocks = 1 << 16;
  const std::size_t blocks = (numbers + independent_lanes - 1) / independent_lanes;
  return {static_cast<int>(std::clamp<std::size_t>(blocks, 1, most_blocks)), independent_lanes, 0};
}

}  // namespace apsis
