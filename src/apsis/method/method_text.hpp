#pragma once

#include <string>
#include <string_view>

namespace apsis {

/// Checks the text of a method file before it is parsed, because deep nesting would overflow the stack of a
/// recursive parser. Throws input_error with the position of the first offending byte. The text has at most 1
/// MiB. A key has at most 8 parts ("a.b.c" has 3), a value at most 8 nested lists or tables.
void check_method_text(std::string_view text, const std::string& file);

/// Returns why a string cannot be the name of a method, with a suggestion; "" if it can. A name has 1 to 60
/// letters, digits, '-', '_', '+' and '.', because it becomes part of file names and messages. It begins with
/// a letter or digit and does not end in ".toml", which marks files.
std::string method_name_problem(std::string_view name);

}  // namespace apsis
