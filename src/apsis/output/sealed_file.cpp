#include <apsis/output/sealed_file.hpp>

#include <apsis/core/errors.hpp>
#include <apsis/core/new_file.hpp>

#include <array>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <memory>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#define XXH_INLINE_ALL
#include <xxhash.h>

namespace apsis {
namespace {

[[noreturn]] void unusable(const std::string& path, const std::string& kind, const std::string& why) {
  throw io_error(fmt::format(
      "'{}' is not a usable {} ({}); give one that was written by this version of apsis", path, kind, why));
}

/// Content of a seal. The checksum covers everything in the file except itself.
struct seal_text {
  std::string kind, version;
  std::uint64_t bytes = 0;

  std::string head() const { return fmt::format("apsis {}\nversion {}\nbytes {}\n", kind, version, bytes); }
  std::string block(const std::string& checksum) const {
    std::string text = head() + "xxh3 " + checksum + "\n";
    text.resize(seal_length, '\0');
    return text;
  }
};

struct free_state {
  void operator()(XXH3_state_t* state) const { XXH3_freeState(state); }
};

/// Returns the checksum of the seal without its checksum line and of everything after the seal.
std::string checksum_of(std::ifstream& file, const std::string& head) {
  const std::unique_ptr<XXH3_state_t, free_state> state(XXH3_createState());
  XXH3_128bits_reset(state.get());
  XXH3_128bits_update(state.get(), head.data(), head.size());
  file.clear();
  file.seekg(static_cast<std::streamoff>(seal_length));
  constexpr std::size_t piece = std::size_t{1} << 20;
  std::vector<char> some(piece);
  while (file.read(some.data(), piece) || file.gcount() > 0)
    XXH3_128bits_update(state.get(), some.data(), static_cast<std::size_t>(file.gcount()));
  const auto sum = XXH3_128bits_digest(state.get());
  return fmt::format("{:016x}{:016x}", sum.high64, sum.low64);
}

std::uint64_t length_of(std::ifstream& file) {
  file.clear();
  file.seekg(0, std::ios::end);
  return static_cast<std::uint64_t>(file.tellg());
}

/// Returns the word that follows `key` at the beginning of a line.
std::string word_after(const std::string& block, const std::string& key) {
  const auto at = block.find("\n" + key + " ");
  if (at == std::string::npos) return {};
  const auto from = at + key.size() + 2, to = block.find('\n', from);
  return to == std::string::npos ? std::string() : block.substr(from, to - from);
}

void write_through(const std::string& path, const std::string& block) {
  const int file = open(path.c_str(), O_WRONLY | O_NOFOLLOW | O_CLOEXEC);
  errno = 0;
  const bool written = file >= 0 &&
                       pwrite(file, block.data(), block.size(), 0) == static_cast<ssize_t>(block.size()) &&
                       fsync(file) == 0;
  const int problem = errno;
  const bool closed = file < 0 || close(file) == 0;
  if (!written || !closed)
    throw io_error(fmt::format("'{}' cannot be written completely ({}); free some space", path,
                               why_not_written(path, problem)));
}

}  // namespace

void seal(const std::string& path, const std::string& kind, const std::string& written_by) {
  std::ifstream file(path, std::ios::binary);
  const seal_text text{kind, written_by, length_of(file)};
  const std::string block = text.block(checksum_of(file, text.head()));
  if (file.bad())
    throw io_error(
        fmt::format("'{}' cannot be read back (damaged disk?); choose another folder with --out", path));
  write_through(path, block);
}

void check_seal(const std::string& path, const std::string& kind) {
  std::ifstream file(path, std::ios::binary);
  if (!file) unusable(path, kind, "it cannot be opened");
  std::string block(seal_length, '\0');
  file.read(block.data(), seal_length);
  const std::string begins = fmt::format("apsis {}\n", kind);
  if (block.compare(0, begins.size(), begins) != 0) unusable(path, kind, "its header is missing or damaged");
  const std::uint64_t length = length_of(file);
  const std::string bytes = word_after(block, "bytes");
  if (bytes != std::to_string(length))
    unusable(path, kind, fmt::format("it has {} bytes instead of '{}'", length, bytes));
  const seal_text text{kind, word_after(block, "version"), length};
  if (block != text.block(checksum_of(file, text.head())))
    unusable(path, kind, "its checksum does not match its content");
  if (text.version != version())
    unusable(path, kind, fmt::format("it was written by version {}, this is {}", text.version, version()));
}

}  // namespace apsis
