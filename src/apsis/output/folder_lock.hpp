#pragma once

#include <filesystem>
#include <string>

namespace apsis {

/// Exclusive right to write into a folder: an advisory lock (flock) on the file `.lock` in it. The kernel
/// releases the lock however its holder ends, so a lock file left behind by a killed run is harmless.
class folder_lock {
 public:
  /// Locks an existing folder. Throws io_error if another process holds the lock, and names this
  /// process. Also throws it if the lock file cannot be created, or is a link. A file system without
  /// locks only causes a warning.
  explicit folder_lock(std::filesystem::path folder);
  /// Removes the file and releases the lock.
  ~folder_lock();
  folder_lock(const folder_lock&) = delete;
  folder_lock& operator=(const folder_lock&) = delete;

 private:
  void take();
  [[noreturn]] void refuse(const std::string& why, int code) const;

  std::filesystem::path path_;
  int file_ = -1;
};

}  // namespace apsis
