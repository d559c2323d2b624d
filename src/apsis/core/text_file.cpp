#include <apsis/core/text_file.hpp>

#include <apsis/core/errors.hpp>
#include <apsis/core/new_file.hpp>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <string_view>

#include <fmt/format.h>
#include <unistd.h>

namespace apsis {

std::string read_text_file(const std::string& path, std::size_t longest, const std::string& kind) {
  std::ifstream in(path, std::ios::binary);
  std::string text, block(std::size_t{1} << 16U, '\0');
  while (in.good() && text.size() <= longest) {
    in.read(block.data(), static_cast<std::streamsize>(std::min(block.size(), longest + 1 - text.size())));
    text.append(block, 0, static_cast<std::size_t>(in.gcount()));
  }
  std::error_code ignored;
  // A read may fail after the file was opened. Partial contents are not returned.
  if (in.bad() || !in.is_open() || std::filesystem::is_directory(path, ignored))
    throw io_error(
        fmt::format("cannot read '{}' (it is a folder or not readable); give a readable {}", path, kind));
  return text;
}

void write_text_file(const std::string& path, const std::string& text, const std::string& suggestion) {
  const int file = create_new_file(path);
  int problem = file < 0 ? errno : 0;
  for (std::string_view rest = text; problem == 0 && !rest.empty();) {
    const ssize_t put = write(file, rest.data(), rest.size());
    if (put < 0 && errno == EINTR) continue;
    if (put <= 0)
      problem = put < 0 ? errno : ENOSPC;
    else
      rest.remove_prefix(static_cast<std::size_t>(put));
  }
  if (file >= 0 && close(file) != 0 && problem == 0) problem = errno;
  if (problem != 0)
    throw io_error(
        fmt::format("cannot write '{}' ({}); {}", path, why_not_written(path, problem), suggestion));
}

}  // namespace apsis
