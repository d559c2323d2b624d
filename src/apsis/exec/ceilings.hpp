#pragma once

#include <cstddef>

namespace apsis {

/// Performance ceilings of one core with the instruction set of the kernels, measured at each call (some tens
/// of milliseconds). Each is the best of several attempts, because a ceiling is the performance of an
/// undisturbed machine.

/// Measures the memory bandwidth in bytes per second: a ← b + s c on arrays of `count` doubles each, 24
/// bytes per element.
double triad_bytes_per_second(std::size_t count);

/// Measures multiply–adds per second on numbers in registers.
double multiply_adds_per_second();

/// Measures the CPU time, in seconds, of `count` multiply–adds on this thread. It is a unit of time that
/// follows the clock rate of the core.
double seconds_of_multiply_adds(double count);

}  // namespace apsis
