#pragma once

#include <exception>
#include <utility>

namespace apsis {

/// The first exception of several pieces of work that all have to run, because other processes wait for them.
class first_error {
 public:
  /// Runs body() and keeps its exception if there is none yet.
  template <class Body>
  void run(const Body& body) {
    try {
      body();
    } catch (...) {
      if (!kept_) kept_ = std::current_exception();
    }
  }
  /// Whether an exception is kept.
  explicit operator bool() const { return static_cast<bool>(kept_); }
  /// Returns the exception and keeps none.
  std::exception_ptr take() { return std::exchange(kept_, nullptr); }
  /// Throws the exception if there is one.
  void rethrow() {
    if (kept_) std::rethrow_exception(take());
  }

 private:
  std::exception_ptr kept_;
};

}  // namespace apsis
