#pragma once

#include <apsis/core/version.hpp>

#include <string>

namespace apsis {

/// A seal is the beginning of a file, which says what the file is, how long it should be, and a checksum
/// (XXH3, 128 bit) of everything else. A file that was cut short or changed in any bit does not pass for a
/// whole one. HDF5 leaves room for it (the user block) and opens such files as any others.
inline constexpr unsigned long seal_length = 512;

/// Writes the seal into the first seal_length bytes, which must be there, and sees the file through to the
/// disk. `kind` is a word such as "checkpoint". Throws io_error.
void seal(const std::string& path, const std::string& kind, const std::string& written_by = version());

/// Throws io_error with the reason: no such file, of another kind, cut short, changed, or written by another
/// version.
void check_seal(const std::string& path, const std::string& kind);

}  // namespace apsis
