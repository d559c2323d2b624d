#pragma once

#include <apsis/core/random_source.hpp>

/// Returns a number of the size of velocities.
inline double any_velocity(apsis::random_source& random) {
  return random.uniform(-15.0, 15.0);
}
