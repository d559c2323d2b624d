#include <apsis/core/text_file.hpp>

#include <apsis/core/errors.hpp>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include <fmt/format.h>

namespace apsis {

std::string read_text_file(const std::string& path, std::size_t longest, const std::string& kind) {
  std::ifstream in(path, std::ios::binary);
  std::string text, block(std::size_t{1} << 16U, '\0');
  while (in.good() && text.size() <= longest) {
    in.read(block.data(), static_cast<std::streamsize>(std::min(block.size(), longest + 1 - text.size())));
    text.append(block, 0, static_cast<std::size_t>(in.gcount()));
  }
  std::error_code ignored;
  // A read may fail after the file was opened; a partial content is not used.
  if (in.bad() || !in.is_open() || std::filesystem::is_directory(path, ignored))
    throw io_error(
        fmt::format("cannot read '{}' (it is a folder or not readable); give a readable {}", path, kind));
  return text;
}

void write_text_file(const std::string& path, const std::string& text, const std::string& suggestion) {
  std::ofstream out(path, std::ios::binary);
  out << text;
  out.close();
  if (!out)
    throw io_error(fmt::format("cannot write '{}' (no permission or no space left); {}", path, suggestion));
}

}  // namespace apsis
