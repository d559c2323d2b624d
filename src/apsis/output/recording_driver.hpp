#pragma once

#include <cstdint>

namespace apsis {

/// Returns a new HDF5 file access property list for files that are written; the caller closes it. HDF5 cannot
/// close a file that it failed to write, and crashes when the process ends with such a file. The driver of
/// this list therefore hides failures from HDF5. It records errno of the first one in `error`, which must
/// outlive the file, and discards all later writes. With `only_numbers` it opens an existing file and writes
/// only the numbers of datasets. Several processes may do so simultaneously. Returns a negative number if
/// HDF5 is out of memory.
std::int64_t make_recording_access(int* error, bool only_numbers = false);

}  // namespace apsis
