#pragma once

#include <string>

namespace apsis {

/// Creates a file for reading and writing and returns its descriptor, or −1 with errno if that fails. An
/// earlier file or link of this name is removed first. The function never writes through a link: in a folder
/// that others can write, a link may point to any file of the user. If the name belongs to something else,
/// such as a folder, the call fails with EEXIST.
int create_new_file(const std::string& path);

/// Returns the reason why a file could not be written, from an errno value. Examples are "No space left on
/// device" and "there is no folder 'o', it may have been deleted".
std::string why_not_written(const std::string& path, int code);

}  // namespace apsis
