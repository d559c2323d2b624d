#pragma once

#include <cstdint>
#include <string>

namespace apsis {

/// Whether an open dataset of HDF5 has integers or floating-point numbers.
bool holds_real_numbers(std::int64_t data);

/// Returns why the numbers of an open dataset of HDF5 cannot be read, as the rest of a message that begins
/// with its name; "" if they can. A part that was never written reads as zeros, without an error, unless the
/// file gives a value for it: a result that was not written completely must not be mistaken for a zero state.
/// Compressed numbers count as they are: their size in the file says nothing about it.
std::string problem_of_storage(std::int64_t data);

}  // namespace apsis
