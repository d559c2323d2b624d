#pragma once

#include <mutex>
#include <string>
#include <vector>

namespace apsis {

/// Records the warnings of this process while the object lives, including those that
/// log::level hides. Thread-safe.
class warning_record {
 public:
  warning_record();
  ~warning_record();
  warning_record(const warning_record&) = delete;
  warning_record& operator=(const warning_record&) = delete;

  /// Returns the warnings so far, in order.
  std::vector<std::string> messages() const;
  /// Adds a warning to all records of this process.
  static void add_to_all(const std::string& message);

 private:
  mutable std::mutex mutex_;
  std::vector<std::string> messages_;
};

}  // namespace apsis
