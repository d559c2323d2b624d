#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace apsis {

/// The words of a text on lines of at most `width` bytes; a longer word has a line of its own. At least one
/// line, which is empty for an empty text.
std::vector<std::string> word_wrap(std::string_view text, std::size_t width);

}  // namespace apsis
