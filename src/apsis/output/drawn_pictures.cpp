#include <apsis/output/drawn_pictures.hpp>

#include <cstddef>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <optional>
#include <sstream>
#include <string>
#include <system_error>

namespace apsis {
namespace fs = std::filesystem;
namespace {

constexpr const char* list_name = ".written";  // python/apsis/plot/style.py writes it

/// Returns the content of a regular file; nothing for links and unreadable files.
std::optional<std::string> content_of(const fs::path& path) {
  std::error_code ignored;
  if (fs::symlink_status(path, ignored).type() != fs::file_type::regular) return std::nullopt;
  std::ifstream in(path, std::ios::binary);
  if (!in) return std::nullopt;
  return std::string(std::istreambuf_iterator<char>(in), {});
}

/// Returns the CRC-32 of zlib.
std::uint32_t checksum(const std::string& data) {
  std::uint32_t sum = 0xFFFFFFFFU;
  for (const char c : data) {
    sum ^= static_cast<unsigned char>(c);
    for (int bit = 0; bit < 8; ++bit) sum = (sum >> 1) ^ ((sum & 1U) != 0U ? 0xEDB88320U : 0U);
  }
  return ~sum;
}

}  // namespace

picture_counts remove_drawn_pictures(const fs::path& results) {
  const fs::path pictures = results / "pictures";
  picture_counts counts;
  std::error_code problem;
  if (fs::symlink_status(pictures, problem).type() != fs::file_type::directory) return counts;
  std::istringstream lines(content_of(pictures / list_name).value_or(""));
  std::uint32_t sum = 0;
  std::size_t size = 0;
  std::string name;
  while (lines >> std::hex >> sum >> std::dec >> size && std::getline(lines >> std::ws, name)) {
    // Only files of this folder: the list may come from others.
    if (name.empty() || name.front() == '.' || name.find('/') != std::string::npos) continue;
    const auto content = content_of(pictures / name);
    if (!content || content->size() != size || checksum(*content) != sum) continue;
    if (fs::remove(pictures / name, problem)) ++counts.removed;
  }
  for (const auto& entry : fs::directory_iterator(pictures, problem))
    if (entry.path().filename() != list_name) ++counts.left;
  fs::remove(pictures / list_name, problem);
  fs::remove(pictures, problem);  // only an empty folder
  return counts;
}

}  // namespace apsis
