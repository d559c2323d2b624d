#pragma once

#include <string>

namespace apsis {

/// Creates a file, removes an earlier one of this name before, and returns its descriptor, for reading and
/// writing; −1 with errno if that fails. Nothing is written through a link: in a folder that comes from
/// others, or into which they can write, it may lead to any file of the user. Something that is neither a
/// file nor a link stays, and the error is EEXIST.
int create_new_file(const std::string& path);

/// Returns why a file could not be written, from an errno value: "No space left on device", or "there is no
/// folder 'o', it may have been deleted".
std::string why_not_written(const std::string& path, int code);

}  // namespace apsis
