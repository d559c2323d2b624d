#include <apsis/core/new_file.hpp>

#include <cerrno>
#include <filesystem>
#include <system_error>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

namespace apsis {

int create_new_file(const std::string& path) {
  struct stat there = {};
  if (lstat(path.c_str(), &there) == 0 && (S_ISREG(there.st_mode) || S_ISLNK(there.st_mode)) &&
      unlink(path.c_str()) != 0 && errno != ENOENT)
    return -1;
  return open(path.c_str(), O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
}

std::string why_not_written(const std::string& path, int code) {
  std::error_code ignored;
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  if (code == ENOENT && !folder.empty() && !std::filesystem::exists(folder, ignored))
    return fmt::format("there is no folder '{}', it may have been deleted", folder.string());
  if (code == EEXIST) return "something that is not a file has this name";
  if (code == ELOOP) return "it is a symbolic link";
  return code == 0 ? "no reason is known" : std::generic_category().message(code);
}

}  // namespace apsis
