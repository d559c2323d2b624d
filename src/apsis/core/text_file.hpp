#pragma once

#include <cstddef>
#include <string>

namespace apsis {

/// Reads a file, at most `longest` + 1 bytes of it, so that a parser can reject files that are too long
/// without reading them entirely. Throws io_error ("… give a readable `kind`") if the file cannot be read to
/// its end or is a folder.
std::string read_text_file(const std::string& path, std::size_t longest, const std::string& kind);

/// Writes a file anew, never through a link (create_new_file). Throws io_error, whose message has the reason
/// and ends in `suggestion`, if not all of it could be written.
void write_text_file(const std::string& path, const std::string& text,
                     const std::string& suggestion = "free some space or choose another place");

}  // namespace apsis
