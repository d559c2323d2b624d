#include <apsis/core/printable.hpp>

#include <cstddef>
#include <cstdint>

#include <fmt/format.h>

namespace apsis {
namespace {

/// A code point and its number of bytes; 0 bytes if the text is not UTF-8.
struct code_point {
  std::uint32_t value;
  std::size_t bytes;
};

code_point first_of(std::string_view text) {
  const auto byte = [&text](std::size_t k) {
    return static_cast<std::uint32_t>(static_cast<unsigned char>(text[k]));
  };
  const std::uint32_t head = byte(0);
  if (head < 0x80) return {head, 1};
  const std::size_t bytes = head >= 0xF0 && head < 0xF5   ? 4
                            : head >= 0xE0 && head < 0xF0 ? 3
                            : head >= 0xC2 && head < 0xE0 ? 2
                                                          : 0;
  if (bytes == 0 || text.size() < bytes) return {head, 0};
  std::uint32_t value = head & (0x7FU >> bytes);
  for (std::size_t k = 1; k < bytes; ++k) {
    if ((byte(k) & 0xC0U) != 0x80) return {head, 0};
    value = value << 6U | (byte(k) & 0x3FU);
  }
  // An overlong encoding, half of a surrogate pair, or a number beyond the last code point.
  const bool invalid = (bytes == 3 && value < 0x800) || (bytes == 4 && value < 0x10000) ||
                       (value >= 0xD800 && value < 0xE000) || value > 0x10FFFF;
  return {invalid ? head : value, invalid ? 0 : bytes};
}

/// Returns true for control characters of both blocks, bidirectional marks and overrides,
/// and line separators.
bool controls(std::uint32_t c) {
  if (c == '\n' || c == '\t') return false;
  return c < 0x20 || (c >= 0x7F && c < 0xA0) || c == 0x061C || c == 0x200E || c == 0x200F ||
         (c >= 0x2028 && c <= 0x202E) || (c >= 0x2066 && c <= 0x2069);
}

}  // namespace

std::string printable(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  while (!text.empty()) {
    const auto [value, bytes] = first_of(text);
    if (bytes == 0)
      out += fmt::format("\\x{:02x}", value);
    else if (controls(value))
      out += fmt::format("\\u{:04x}", value);
    else
      out += text.substr(0, bytes);
    text.remove_prefix(bytes == 0 ? 1 : bytes);
  }
  return out;
}

}  // namespace apsis
