#pragma once

#include <string>
#include <string_view>

namespace apsis {

/// Checks the text of a method file before it is parsed. Throws input_error with the position of the first
/// offending byte if the text is larger than 1 MiB, has a key of more than 8 parts ("a.b.c" has 3) or values
/// nested deeper than 8 lists or tables: a recursive parser would overflow the stack.
void check_method_text(std::string_view text, const std::string& file);

/// Returns why a string cannot be the name of a method, with a suggestion; "" if it can. Names become part of
/// file names and messages: 1 to 60 letters, digits, '-', '_', '+' and '.', beginning with a letter or digit,
/// and not ending in ".toml", which marks files.
std::string method_name_problem(std::string_view name);

}  // namespace apsis
