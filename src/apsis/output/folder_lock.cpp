#include <apsis/output/folder_lock.hpp>

#include <apsis/core/errors.hpp>
#include <apsis/core/log.hpp>
#include <apsis/core/new_file.hpp>
#include <apsis/output/provenance.hpp>

#include <cerrno>
#include <fstream>
#include <string>
#include <system_error>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

namespace apsis {
namespace {

/// Returns the line that the holder wrote: "process 123 on host since …".
std::string holder(const std::filesystem::path& lock) {
  std::string line;
  std::ifstream in(lock);
  return std::getline(in, line) ? line : "another process";
}

/// Returns whether `path` still names the open file. Its last holder may have removed it meanwhile.
bool names(const std::filesystem::path& path, int file) {
  struct stat there = {}, here = {};
  return stat(path.c_str(), &there) == 0 && fstat(file, &here) == 0 && there.st_ino == here.st_ino &&
         there.st_dev == here.st_dev;
}

}  // namespace

folder_lock::folder_lock(std::filesystem::path folder) : path_(std::move(folder)) {
  path_ /= ".lock";
  try {
    take();
  } catch (...) {
    if (file_ >= 0) close(file_);
    throw;
  }
}

void folder_lock::refuse(const std::string& why, int code) const {
  throw io_error(fmt::format("cannot write '{}' ({}); choose another folder with --out{}", path_.string(),
                             why, code == ENOSPC ? " or free some space" : ""));
}

void folder_lock::take() {
  while (true) {
    file_ = open(path_.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC, 0666);
    if (file_ < 0) {
      const int why = errno;
      refuse(why_not_written(path_.string(), why), why);
    }
    // Others may have planted the name as a link to another file of the user, which must not be overwritten.
    struct stat found = {};
    if (fstat(file_, &found) != 0 || !S_ISREG(found.st_mode) || found.st_nlink > 1)
      refuse("another file may have this name too, or it is not a file", EEXIST);
    if (flock(file_, LOCK_EX | LOCK_NB) != 0) {
      const int why = errno;
      if (why == EWOULDBLOCK)
        throw io_error(fmt::format(
            "the folder '{}' is in use ({}); wait for that run to end or choose another folder with "
            "--out",
            path_.parent_path().string(), holder(path_)));
      log::warning(fmt::format("'{}' cannot be locked ({}); do not start a second run into this folder",
                               path_.parent_path().string(), std::generic_category().message(why)));
      return;
    }
    if (names(path_, file_)) break;
    close(file_);
  }
  const std::string me = fmt::format("process {} on {} since {}\n", getpid(), host_name(), time_stamp());
  if (ftruncate(file_, 0) != 0 || pwrite(file_, me.data(), me.size(), 0) != static_cast<ssize_t>(me.size())) {
    const int why = errno;
    unlink(path_.c_str());
    refuse(why_not_written(path_.string(), why), why);
  }
}

folder_lock::~folder_lock() {
  if (names(path_, file_)) unlink(path_.c_str());
  close(file_);
}

}  // namespace apsis
