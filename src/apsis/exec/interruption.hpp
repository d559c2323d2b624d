#pragma once

#include <apsis/core/errors.hpp>

#include <functional>

namespace apsis {

/// Work before the first step was interrupted, so that there is nothing to save.
class interrupted_error : public error {
 public:
  /// what() says so.
  interrupted_error();
};

/// Makes work of the calling thread interruptible for its lifetime: long loops before the first step poll.
class interruptible {
 public:
  /// `check`: called by poll() some 20 times a second; it throws to end the work.
  explicit interruptible(std::function<void()> check);
  ~interruptible();
  interruptible(const interruptible&) = delete;
  interruptible& operator=(const interruptible&) = delete;

  /// Called by loops between pieces of their work; costs a comparison where nothing is interruptible, and
  /// else the reading of a clock.
  static void poll();

 private:
  std::function<void()> check_;
  interruptible* outer_;
};

}  // namespace apsis
