#pragma once

#include <string>
#include <string_view>

namespace apsis {

/// Returns a text that a terminal shows and does not obey. Texts of cases, results and other people's files
/// may have control characters, which move the cursor, change the title of the window, or reverse the order
/// of characters: they become "\u001b", bytes that are not UTF-8 "\x9b". Tabs and ends of lines stay.
std::string printable(std::string_view text);

}  // namespace apsis
