#pragma once

#include <string>
#include <string_view>

namespace apsis {

/// Throws input_error with the place of the first byte too many, before a parser sees the text, if it is
/// larger than 1 MiB, has a key of more than 8 parts ("a.b.c" has 3) or values nested deeper than 8 lists or
/// tables: a parser that calls itself for each of them would run out of stack.
void check_method_text(std::string_view text, const std::string& file);

/// Why a text cannot be the name of a method, with a suggestion; "" if it can. A name becomes part of file
/// names and messages: 1 to 60 letters, digits, '-', '_', '+' and '.', the first one a letter or digit, not
/// ending in
/// ".toml", by which files are recognised.
std::string method_name_problem(std::string_view name);

}  // namespace apsis
