#pragma once

#include <apsis/device/device.hpp>

#include <cstddef>

namespace apsis {

/// Performance ceilings of a device, measured by kernels at each call. Each is the best of several attempts,
/// because a ceiling is the performance of an undisturbed machine.

/// Measures the memory bandwidth in bytes per second: copies of arrays of `count` numbers each, 16 bytes per
/// number.
double copy_bytes_per_second(device& on, std::size_t count);

/// Measures multiply–adds per second on numbers in registers.
double multiply_adds_per_second(device& on);

}  // namespace apsis
