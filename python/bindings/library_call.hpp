#pragma once

#include <apsis/exec/interruption.hpp>
#include <apsis/exec/parallel.hpp>
#include <apsis/exec/thread_team.hpp>

#include <pybind11/pybind11.h>

namespace apsis::python {

/// A call of the library from Python, for its lifetime: loops that this thread starts use `n` threads, and
/// those of other threads of Python keep their own number. The call may come from a function of the user that
/// a loop of the library has called; its own loops then run on this thread alone and as thread 0, for which
/// they prepare their scratch memory.
class library_call {
 public:
  /// Throws input_error as set_threads() does.
  explicit library_call(int n) : threads_(threads()), position_(this_thread_position()) {
    set_threads(n);
    this_thread_position().number = 0;
  }
  ~library_call() {
    this_thread_position() = position_;
    set_threads(threads_);
  }
  library_call(const library_call&) = delete;
  library_call& operator=(const library_call&) = delete;

 private:
  int threads_;
  region_position position_;
};

/// Ends work before the first step with KeyboardInterrupt where Python has a signal.
inline void raise_pending_signals() {
  const pybind11::gil_scoped_acquire python;
  if (PyErr_CheckSignals() != 0) throw pybind11::error_already_set();
}

}  // namespace apsis::python
