#include <apsis/body/read_stl.hpp>

#include <apsis/core/embedded.hpp>
#include <apsis/core/errors.hpp>
#include <apsis/core/text_file.hpp>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>

#include <fmt/format.h>

namespace apsis {
namespace {

constexpr std::size_t header_bytes = 84, facet_bytes = 50;

char lower(char letter) {
  return letter >= 'A' && letter <= 'Z' ? static_cast<char>(letter - 'A' + 'a') : letter;
}

bool is_blank(char letter) {
  return letter == ' ' || (letter >= '\t' && letter <= '\r');
}

bool equals_word(std::string_view word, std::string_view keyword) {
  return std::equal(word.begin(), word.end(), keyword.begin(), keyword.end(),
                    [](char a, char b) { return lower(a) == b; });
}

/// Reads the words of an ASCII file.
class stl_words {
 public:
  stl_words(std::string_view text, const std::string& path) : rest_(text), path_(path) {}

  std::vector<space_triangle> read() {
    std::vector<space_triangle> triangles;
    for (skip_blanks(); !rest_.empty(); skip_blanks()) {
      expect("solid");
      skip_line();  // the name of the solid
      std::string_view word = next("endsolid");
      for (; equals_word(word, "facet"); word = next("endsolid")) triangles.push_back(facet());
      check(word, "endsolid");
      skip_line();
    }
    return triangles;
  }

 private:
  [[noreturn]] void fail(const std::string& message) const { throw input_error({path_, line_, 0}, message); }

  void skip_blanks() {
    while (!rest_.empty() && is_blank(rest_.front())) {
      line_ += rest_.front() == '\n' ? 1 : 0;
      rest_.remove_prefix(1);
    }
  }

  void skip_line() { rest_.remove_prefix(std::min(rest_.find('\n'), rest_.size())); }

  std::string_view next(const char* expected) {
    skip_blanks();
    if (rest_.empty())
      fail(fmt::format("the file ends before '{}' (it is truncated); write it again", expected));
    const auto end = std::find_if(rest_.begin(), rest_.end(), is_blank);
    const std::string_view word = rest_.substr(0, static_cast<std::size_t>(end - rest_.begin()));
    rest_.remove_prefix(word.size());
    return word;
  }

  void check(std::string_view word, const char* expected) const {
    if (!equals_word(word, expected))
      fail(fmt::format("'{}' instead of '{}' (the text is not that of an STL file); write it again",
                       word.substr(0, 60), expected));
  }

  void expect(const char* keyword) { check(next(keyword), keyword); }

  double coordinate() {
    const std::string_view word = next("vertex"), digits = word.substr(word.starts_with('+') ? 1 : 0);
    double value = 0.0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (error == std::errc::invalid_argument || end != digits.data() + digits.size())
      fail(fmt::format("'{}' is not a number (a vertex has three); write it again", word.substr(0, 60)));
    const float rounded = error == std::errc() ? static_cast<float>(value) : HUGE_VALF;
    if (!std::isfinite(rounded))
      fail(fmt::format("the coordinate {} is not finite (in single precision); write it again",
                       word.substr(0, 60)));
    return static_cast<double>(rounded);
  }

  space_triangle facet() {
    expect("normal");
    for (int k = 0; k < 3; ++k) next("normal");
    expect("outer");
    expect("loop");
    space_triangle corners = {};
    for (position& corner : corners) {
      expect("vertex");
      for (double& x : corner) x = coordinate();
    }
    expect("endloop");
    expect("endfacet");
    return corners;
  }

  std::string_view rest_;
  const std::string& path_;
  int line_ = 1;
};

/// Returns the number in four bytes, with the lowest byte first.
std::uint32_t word_at(std::string_view bytes, std::size_t at) {
  std::uint32_t word = 0;
  for (std::size_t k = 4; k-- > 0;) word = (word << 8U) | static_cast<unsigned char>(bytes[at + k]);
  return word;
}

/// Returns the size of a binary file according to the number of triangles in its header.
std::uint64_t size_by_header(std::string_view bytes) {
  return header_bytes + std::uint64_t{facet_bytes} * word_at(bytes, header_bytes - 4);
}

bool is_text(std::string_view bytes) {
  const auto first = std::find_if_not(bytes.begin(), bytes.end(), is_blank);
  const std::string_view rest = bytes.substr(static_cast<std::size_t>(first - bytes.begin()));
  // Even a truncated binary file has bytes 0, at least those behind a triangle.
  return equals_word(rest.substr(0, 5), "solid") && bytes.find('\0') == std::string_view::npos;
}

std::vector<space_triangle> read_binary_stl(std::string_view bytes, const std::string& path) {
  if (bytes.size() < header_bytes)
    throw input_error({path, 0, 0},
                      fmt::format("the file has {} bytes (neither 'solid' nor the {} bytes of a "
                                  "binary header); give an STL file",
                                  bytes.size(), header_bytes));
  if (bytes.size() != size_by_header(bytes))
    throw input_error(
        {path, 0, 0},
        fmt::format("the file has {} bytes ({} triangles at byte {} need {}); write it again", bytes.size(),
                    word_at(bytes, header_bytes - 4), header_bytes - 4, size_by_header(bytes)));
  std::vector<space_triangle> triangles((bytes.size() - header_bytes) / facet_bytes);
  std::size_t at = header_bytes;
  for (space_triangle& corners : triangles) {
    at += 12;  // the normal
    for (position& corner : corners)
      for (double& x : corner) {
        const float value = std::bit_cast<float>(word_at(bytes, at));
        if (!std::isfinite(value))
          throw input_error(
              {path, 0, 0},
              fmt::format("the coordinate {} at byte {} is not finite (in triangle {}); write it again",
                          value, at, (at - header_bytes) / facet_bytes + 1));
        x = static_cast<double>(value);
        at += 4;
      }
    at += 2;  // an attribute
  }
  return triangles;
}

}  // namespace

std::optional<std::string> built_in_stl(const std::string& name) {
  for (const auto& built_in : embedded::surfaces())
    if (name == fmt::format("{}.stl", built_in.name)) return std::string(built_in.text);
  return std::nullopt;
}

std::vector<space_triangle> read_stl(const std::string& path) {
  constexpr std::size_t longest = 2'000'000'000;
  const auto built_in = built_in_stl(path);
  const std::string bytes = built_in ? *built_in : read_text_file(path, longest, "STL file");
  if (bytes.size() > longest)
    throw input_error(
        {path, 0, 0},
        fmt::format("the file has more than {} bytes (its surface is too fine); coarsen it", longest));
  const bool is_binary = bytes.size() >= header_bytes && bytes.size() == size_by_header(bytes);
  auto triangles =
      !is_binary && is_text(bytes) ? stl_words(bytes, path).read() : read_binary_stl(bytes, path);
  if (triangles.empty())
    throw input_error({path, 0, 0}, "the file has no triangles (it describes no surface); give another");
  return triangles;
}

}  // namespace apsis
