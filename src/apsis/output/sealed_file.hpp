#pragma once

#include <apsis/core/version.hpp>

#include <string>

namespace apsis {

/// Length of a seal in bytes. A seal is a header with the kind of the file, its length and a checksum (XXH3,
/// 128 bit) of everything else. It reveals truncation and the change of any bit. It lies in the user block of
/// HDF5, which opens sealed files like any other.
inline constexpr unsigned long seal_length = 512;

/// Writes the seal into the first seal_length bytes, which must exist, and flushes the file to disk. `kind`
/// is a word such as "checkpoint". Throws io_error.
void seal(const std::string& path, const std::string& kind, const std::string& written_by = version());

/// Throws io_error if the file is missing, of another kind, truncated, changed, or written by another
/// version.
void check_seal(const std::string& path, const std::string& kind);

}  // namespace apsis
