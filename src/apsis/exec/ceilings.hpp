#pragma once

#include <cstddef>

namespace apsis {

/// What one core can do at best with the instruction set of the kernels, measured now (some tens of
/// milliseconds). The best of some attempts: a ceiling is what the machine does when nobody disturbs it.

/// Bytes per second of a ← b + s c on arrays of `count` doubles each, 24 bytes an element.
double triad_bytes_per_second(std::size_t count);

/// Multiply–adds per second on numbers in registers.
double multiply_adds_per_second();

/// Seconds of CPU time of this thread for so many multiply–adds: a unit of time that follows the speed of a
/// core that drifts.
double seconds_of_multiply_adds(double count);

}  // namespace apsis
