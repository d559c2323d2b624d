#pragma once

#include <string>
#include <string_view>

namespace apsis {

/// The text of a method file, or as much of it as shows that it is none (parse_method refuses more than 1
/// MiB). Throws input_error if it cannot be read.
std::string read_method_text(const std::string& path);

/// Whether a name means a file of the user: it ends in ".toml".
bool is_method_file(std::string_view name);

}  // namespace apsis
