#pragma once

#include <cstddef>
#include <vector>

namespace apsis {

/// Most threads that can be set.
inline constexpr int most_threads = 256;

/// Sets the number of threads that loops over cells use; 0 stands for all processors that this process may
/// use. Throws input_error unless 0 ≤ n ≤ most_threads.
void set_threads(int n);
/// What OMP_NUM_THREADS asks for, at most most_threads; without it all processors that this process may use.
/// A value that is no positive number counts as none, after a warning.
int default_threads();
/// What OMP_NUM_THREADS asks for, as in default_threads(); 0 without it.
int requested_threads();
/// The number that was set, 1 at the beginning.
int threads();
/// The number that a loop begun here uses: 1 inside of another one.
int threads_here();
/// Which of them the calling thread is: 0 … threads_here() − 1 of the loop that runs, 0 outside of loops.
int thread_number();

/// Scratch space for every thread of a loop. It is made ready for all of them before the loop, so that which
/// of them come, and when, does not decide how much memory is taken.
template <class T>
class per_thread {
 public:
  /// Calls make_ready(scratch) for each thread that a loop begun here uses.
  template <class Function>
  void prepare(const Function& make_ready) {
    const auto count = static_cast<std::size_t>(threads_here());
    if (slots_.size() < count) slots_.resize(count);
    for (std::size_t p = 0; p < count; ++p) make_ready(slots_[p].value);
  }
  /// That of the calling thread.
  T& here() { return slots_[static_cast<std::size_t>(thread_number())].value; }

 private:
  struct alignas(64) slot {
    T value;
  };
  std::vector<slot> slots_;
};

/// A call of what was written as a lambda, without the allocation that std::function may need.
struct numbered_job {
  void (*call)(const void* body, int k);  ///< knows the type of the lambda
  const void* body;                       ///< the lambda; it must outlive the job

  /// The job that calls body(k).
  template <class Body>
  static numbered_job of(const Body& body) {
    return {[](const void* b, int k) { (*static_cast<const Body*>(b))(k); }, &body};
  }
  void operator()(int k) const { call(body, k); }  ///< one call
};
/// Compiled part of parallel_for.
void run_parallel_for(int n, numbered_job job);
/// Compiled part of parallel_tasks.
void run_parallel_tasks(int n, numbered_job job);

/// Runs body(k) for k = 0 … n−1, in any order, on all threads; neighbouring k on the same one. Each k writes
/// its own data, so results do not depend on the number of threads. An exception leaves once all have
/// stopped; of several, the one of the smallest k is thrown.
template <class Body>
void parallel_for(int n, const Body& body) {
  run_parallel_for(n, numbered_job::of(body));
}

/// 0 … n−1 cut into blocks of at most `longest`, in a part of equal length for each of `parts` threads. Parts
/// of long blocks end with short ones, so that a thread that comes to the end of its own finds something
/// small to help the others with.
class part_blocks {
 public:
  /// n ≥ 0 and longest ≥ 1; fewer than one part counts as one.
  part_blocks(int n, int longest, int parts);

  int count() const { return parts_ * per_part(); }      ///< blocks, some of which may be empty
  int begin(int block) const;                            ///< begin(count()) is n
  int end(int block) const { return begin(block + 1); }  ///< one behind the last number of the block

 private:
  int per_part() const { return whole_ - 1 + pieces_; }

  int n_, parts_, whole_, pieces_;
};

/// Runs body(begin, end) for blocks of 0 … n−1 on all threads; see parallel_for. Whatever the length of the
/// blocks, every thread has the same part of the range: loops over the cells of a field that use this find
/// them in the caches of the core that wrote them.
template <class Body>
void parallel_blocks(int n, int longest, const Body& body) {
  const part_blocks blocks(n, longest, threads());
  parallel_for(blocks.count(), [&](int block) {
    const int begin = blocks.begin(block), end = blocks.end(block);
    if (begin < end) body(begin, end);
  });
}

/// The same for jobs of different length (whole runs): a thread that is free takes the next k. Loops inside a
/// job run on its own thread. Once a job has failed no new one begins.
template <class Body>
void parallel_tasks(int n, const Body& body) {
  run_parallel_tasks(n, numbered_job::of(body));
}

}  // namespace apsis
