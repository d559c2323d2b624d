#pragma once

#include <apsis/core/errors.hpp>

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>

namespace apsis {

/// Returns the line and the column, both from 1, of a byte of a text that was read from `file`.
inline source_place place_at(std::string_view text, std::size_t byte, const std::string& file) {
  const std::string_view before = text.substr(0, byte);
  const auto line = std::count(before.begin(), before.end(), '\n') + 1;
  const auto start = before.rfind('\n');
  const std::size_t column = byte - (start == std::string_view::npos ? 0 : start + 1) + 1;
  return {file, static_cast<int>(line), static_cast<int>(column)};
}

}  // namespace apsis
