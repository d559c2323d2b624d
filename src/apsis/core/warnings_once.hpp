#pragma once

#include <string>

namespace apsis {

/// Hides repeated warnings of this process during its life: those that differ from an earlier one in numbers
/// alone. Many runs of a study give such warnings. Thread-safe.
class warnings_once {
 public:
  warnings_once();
  ~warnings_once();
  warnings_once(const warnings_once&) = delete;
  warnings_once& operator=(const warnings_once&) = delete;

  /// Whether no object lives, or none of its earlier warnings differs from this one in numbers alone.
  static bool is_new(const std::string& message);
};

}  // namespace apsis
