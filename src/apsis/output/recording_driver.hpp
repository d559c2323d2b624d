#pragma once

#include <cstdint>

namespace apsis {

/// Returns a new HDF5 file access property list, which the caller closes, for files that are written. HDF5
/// cannot close a file that it failed to write, and crashes when the process ends with such a file. This
/// driver hides failures from HDF5: it records errno of the first one in `error`, which must outlive the
/// file, and discards all later writes. `only_numbers`: opens an existing file, and writes the numbers of
/// datasets alone, so that several processes may do so simultaneously. Returns a negative number if HDF5 is
/// out of memory.
std::int64_t make_recording_access(int* error, bool only_numbers = false);

}  // namespace apsis
