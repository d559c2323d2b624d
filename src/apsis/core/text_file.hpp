#pragma once

#include <cstddef>
#include <string>

namespace apsis {

/// Reads at most `longest` + 1 bytes of a file, so that a parser can reject a file that is too long without
/// reading all of it. Throws io_error ("… give a readable `kind`") if the path is a folder or a read fails.
std::string read_text_file(const std::string& path, std::size_t longest, const std::string& kind);

/// Writes a new file, never through a link (see create_new_file()). Throws io_error if the text could not be
/// written completely. The message has the reason and ends with `suggestion`.
void write_text_file(const std::string& path, const std::string& text,
                     const std::string& suggestion = "free some space or choose another place");

}  // namespace apsis
