#pragma once

#include <apsis/velocity/velocity_set.hpp>

#include <vector>

namespace apsis {

/// Returns for every component the one of the same set with the opposite v_k, k = `direction`, and otherwise
/// the same velocity. Throws input_error if a velocity has no such partner of the same weight.
std::vector<int> mirrored_components(const velocity_set& velocities, int direction);

}  // namespace apsis
