#pragma once

#include <string>
#include <string_view>

namespace apsis {

/// Returns a text that a terminal displays but does not obey. Texts of cases, results and other people's
/// files may contain control characters. These move the cursor, change the title of the window, or reverse
/// the order of characters. Control characters become "\u001b", and bytes that are not UTF-8 become "\x9b".
/// Tabs and line feeds stay.
std::string printable(std::string_view text);

}  // namespace apsis
