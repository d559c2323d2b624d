#pragma once

#include <cstddef>
#include <string>

namespace apsis {

/// The bytes of a file, at most `longest` + 1 of them, so that who parses them sees that a file is too long
/// without reading all of it. Throws io_error ("… give a readable `kind`") if it cannot be read to its end,
/// or is a folder.
std::string read_text_file(const std::string& path, std::size_t longest, const std::string& kind);

/// Writes a file with this content. Throws io_error, which ends in `suggestion`, unless all of it was taken.
void write_text_file(const std::string& path, const std::string& text,
                     const std::string& suggestion = "free some space or choose another place");

}  // namespace apsis
