#pragma once

#include <string>

namespace apsis {

/// Hides repeated warnings of this process while an object lives. A warning is repeated if it differs from an
/// earlier one only in numbers, as warnings of the runs of a study do. Thread-safe.
class warnings_once {
 public:
  warnings_once();
  ~warnings_once();
  warnings_once(const warnings_once&) = delete;
  warnings_once& operator=(const warnings_once&) = delete;

  /// Returns true if no object lives, or if the message differs from all earlier ones in more than numbers.
  static bool is_new(const std::string& message);
};

}  // namespace apsis
