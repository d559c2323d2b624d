#pragma once

#include <cstdint>

namespace apsis {

/// A new HDF5 property list for files to write, to be closed by the caller. HDF5 cannot close a file that it
/// failed to write, and crashes when the process ends with such a file. Here it never sees a failure: the
/// first one is recorded as errno in `error`, which outlives the file, and whatever should be written after
/// that is dropped. Negative if HDF5 has no memory left.
std::int64_t make_recording_access(int* error);

}  // namespace apsis
