#pragma once

#include <apsis/method/method.hpp>

#include <string>
#include <string_view>

namespace apsis {

/// The text of a method file; of one larger than 1 MiB one byte more than that, which parse_method refuses.
/// Throws input_error if it does not exist, io_error if it cannot be read.
std::string read_method_text(const std::string& path);

/// Whether a name means a file of the user: it ends in ".toml".
bool is_method_file(std::string_view name);

/// Why a method from a file cannot have its name, with a suggestion; "" if it can. Refused are names with the
/// pattern of a family that has no such member, and those of a catalogue method or member of a family whose
/// coefficients differ: results of the two could not be told apart.
std::string taken_name(const method& m);

}  // namespace apsis
