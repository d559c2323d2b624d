#pragma once

#include <filesystem>

namespace apsis {

/// The right to write into a folder, held by one process at a time through a lock on the file `.lock` in it
/// (flock). The kernel releases it however the holder ends, so a lock file that a killed run left behind does
/// not matter.
class folder_lock {
 public:
  /// Takes the lock of a folder that exists. Throws io_error, with the process that holds it, if another one
  /// does, or if the file cannot be made. Where the file system knows no locks, a warning says so.
  explicit folder_lock(std::filesystem::path folder);
  /// Removes the file and releases the lock.
  ~folder_lock();
  folder_lock(const folder_lock&) = delete;
  folder_lock& operator=(const folder_lock&) = delete;

 private:
  void take();

  std::filesystem::path path_;
  int file_ = -1;
};

}  // namespace apsis
