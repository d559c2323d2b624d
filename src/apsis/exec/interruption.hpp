#pragma once

#include <apsis/core/errors.hpp>

#include <functional>

namespace apsis {

/// Work before the first step was interrupted, so that there is nothing to save.
class interrupted_error : public error {
 public:
  /// what() states that there is nothing to save.
  interrupted_error();
};

/// Makes work of the calling thread interruptible while this object lives. Long loops before the first step
/// call poll().
class interruptible {
 public:
  /// `check`: called by poll() at most 20 times a second; it throws to end the work.
  explicit interruptible(std::function<void()> check);
  ~interruptible();
  interruptible(const interruptible&) = delete;
  interruptible& operator=(const interruptible&) = delete;

  /// Calls `check` of the innermost object on this thread if 50 ms have passed since the last check. Loops
  /// call it between pieces of their work. It costs a comparison without such an object, otherwise a reading
  /// of the clock.
  static void poll();

 private:
  std::function<void()> check_;
  interruptible* outer_;
};

}  // namespace apsis
