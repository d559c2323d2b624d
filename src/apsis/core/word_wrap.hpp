#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace apsis {

/// Breaks a text into lines of at most `width` bytes; a longer word gets a line of its own. An empty text
/// gives one empty line.
std::vector<std::string> word_wrap(std::string_view text, std::size_t width);

}  // namespace apsis
