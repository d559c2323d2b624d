#pragma once

#include <atomic>

namespace apsis {

/// Base of classes whose objects are expensive and should be constructed once. Counts the objects that were
/// constructed, including copies but not moves. Tests compare the counts before and after.
template <class T>
class construction_count {
 public:
  /// Returns the number of objects that this process has constructed so far.
  static long so_far() { return made_; }

 private:
  friend T;  // the only class that derives from it
  /// @cond
  construction_count() { ++made_; }
  construction_count(const construction_count&) { ++made_; }
  construction_count(construction_count&&) noexcept {}
  construction_count& operator=(const construction_count&) = default;
  construction_count& operator=(construction_count&&) noexcept = default;
  ~construction_count() = default;
  /// @endcond

  inline static std::atomic<long> made_{0};
};

}  // namespace apsis
