#pragma once

#include <exception>
#include <utility>

namespace apsis {

/// Stores the first exception of several pieces of work. All of them have to run, because other processes
/// wait for them.
class first_error {
 public:
  /// Runs body() and stores its exception unless an earlier one is stored.
  template <class Body>
  void run(const Body& body) {
    try {
      body();
    } catch (...) {
      if (!kept_) kept_ = std::current_exception();
    }
  }
  /// Returns true if an exception is stored.
  explicit operator bool() const { return static_cast<bool>(kept_); }
  /// Returns the stored exception and clears it; null without one.
  std::exception_ptr take() { return std::exchange(kept_, nullptr); }
  /// Throws the stored exception, if any, and clears it.
  void rethrow() {
    if (kept_) std::rethrow_exception(take());
  }

 private:
  std::exception_ptr kept_;
};

}  // namespace apsis
