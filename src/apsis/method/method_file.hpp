#pragma once

#include <apsis/method/method.hpp>

#include <string>
#include <string_view>

namespace apsis {

/// Returns the text of a method file. A file larger than 1 MiB is truncated to 1 MiB + 1 byte, which
/// parse_method rejects. Throws input_error if the file does not exist, io_error if it cannot be read.
std::string read_method_text(const std::string& path);

/// Whether a method name is the path of a method file, that is, ends in ".toml".
bool is_method_file(std::string_view name);

/// Returns why a method from a file cannot use its name, with a suggestion; "" if it can. Rejects a name that
/// matches the pattern of a family without being a member. Rejects the name of a catalogue method or family
/// member with different coefficients, because results are filed under the name.
std::string taken_name(const method& m);

}  // namespace apsis
