#pragma once

#include <cstdint>
#include <string>

namespace apsis {

/// Returns whether an open dataset of HDF5 has integers or floating-point numbers.
bool holds_real_numbers(std::int64_t data);

/// Returns the reason why the numbers of an open dataset of HDF5 cannot be read; "" if they can. The reason
/// continues a message that begins with the name of the dataset. HDF5 reads a part that was never written
/// as zeros, without an error. Such datasets are refused unless the file gives a value for unwritten
/// numbers: an incomplete result must not be mistaken for a zero state. The size of compressed numbers in
/// the file does not matter.
std::string problem_of_storage(std::int64_t data);

}  // namespace apsis
