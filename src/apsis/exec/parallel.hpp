#pragma once

#include <cstddef>
#include <vector>

namespace apsis {

/// Maximum number of threads.
inline constexpr int most_threads = 256;

/// Sets the number of threads of loops over cells that the calling thread starts; 0 stands for all processors
/// available to this process.
/// Throws input_error unless 0 ≤ n ≤ most_threads.
void set_threads(int n);
/// Returns the value of OMP_NUM_THREADS, at most most_threads, or, if it is not set, the number of processors
/// available to this process. A value that is not a positive integer is ignored with a warning.
int default_threads();
/// Returns the value of OMP_NUM_THREADS as in default_threads(); 0 if it is not set.
int requested_threads();
/// Returns the number of threads set by the calling thread; initially 1.
int threads();
/// Returns the number of threads of a loop started here: 1 inside another loop, or while a loops_over
/// restricts loops to one thread.
int threads_here();
/// Returns the index of the calling thread: 0 … threads_here() − 1 in a loop, 0 outside loops.
int thread_number();

/// Loops over fewer numbers run on one thread. Several threads would be slower, because they exchange the
/// numbers between their caches in every pass (docs/speed-measured.md, "Threads").
inline constexpr std::size_t fewest_shared_numbers = 16384;
/// Replaces fewest_shared_numbers; for tests of threads on small fields.
void share_loops_from(std::size_t numbers);

/// While an object of this class lives, loops of the calling thread run on this thread alone if they pass
/// over too few numbers.
class loops_over {
 public:
  /// `numbers`: size of the field over which the loops pass.
  explicit loops_over(std::size_t numbers);
  ~loops_over();
  loops_over(const loops_over&) = delete;
  loops_over& operator=(const loops_over&) = delete;

 private:
  bool outermost_;  ///< whether this object restricts loops to one thread
};

/// Scratch space for every thread of a loop. It is prepared for all threads before the loop, so that memory
/// use does not depend on which threads take part.
template <class T>
class per_thread {
 public:
  /// Calls make_ready(scratch) for each thread of a loop started here.
  template <class Function>
  void prepare(const Function& make_ready) {
    const auto count = static_cast<std::size_t>(threads_here());
    if (slots_.size() < count) slots_.resize(count);
    for (std::size_t p = 0; p < count; ++p) make_ready(slots_[p].value);
  }
  /// Calls visit(scratch) for each thread that was ever prepared.
  template <class Function>
  void visit_all(const Function& visit) {
    for (slot& one : slots_) visit(one.value);
  }
  /// Returns the scratch space of the calling thread.
  T& here() { return slots_[static_cast<std::size_t>(thread_number())].value; }

 private:
  struct alignas(64) slot {
    T value;
  };
  std::vector<slot> slots_;
};

/// A reference to a lambda, without the allocation that std::function may need.
struct numbered_job {
  void (*call)(const void* body, int k);  ///< restores the type of the lambda
  const void* body;                       ///< the lambda; it must outlive the job

  /// Returns a job that calls body(k).
  template <class Body>
  static numbered_job of(const Body& body) {
    return {[](const void* b, int k) { (*static_cast<const Body*>(b))(k); }, &body};
  }
  void operator()(int k) const { call(body, k); }  ///< calls body(k)
};
/// Non-template part of parallel_for.
void run_parallel_for(int n, numbered_job job);
/// Non-template part of parallel_tasks.
void run_parallel_tasks(int n, numbered_job job);

/// Runs body(k) for k = 0 … n−1 on all threads, in any order, with neighbouring k on the same thread. Each k
/// must write only its own data; results then do not depend on the number of threads. After all threads have
/// stopped, rethrows the exception of the smallest k that failed.
template <class Body>
void parallel_for(int n, const Body& body) {
  run_parallel_for(n, numbered_job::of(body));
}

/// Splits 0 … n−1 into equal parts, one for each of `parts` threads, and each part into blocks of at most
/// `longest`. At the end of a long part, block sizes taper for load balance.
class part_blocks {
 public:
  /// Requires n ≥ 0 and longest ≥ 1; fewer than one part counts as one.
  part_blocks(int n, int longest, int parts);

  int count() const { return parts_ * per_part(); }      ///< number of blocks, including empty ones
  int begin(int block) const;                            ///< first index of the block; begin(count()) is n
  int end(int block) const { return begin(block + 1); }  ///< one past the last index of the block

 private:
  int per_part() const { return whole_ - 1 + pieces_; }

  int n_, parts_, whole_, pieces_;
};

/// Runs body(begin, end) for blocks of 0 … n−1 on all threads; see parallel_for. Every thread gets the same
/// part of the range, whatever the block length. Later loops over a field then find its cells in the caches
/// of the core that wrote them.
template <class Body>
void parallel_blocks(int n, int longest, const Body& body) {
  const part_blocks blocks(n, longest, threads_here());
  parallel_for(blocks.count(), [&](int block) {
    const int begin = blocks.begin(block), end = blocks.end(block);
    if (begin < end) body(begin, end);
  });
}

/// Runs body(k) for k = 0 … n−1 with dynamic scheduling, for jobs of different cost such as whole runs:
/// an idle thread takes the next k. Loops inside a job run on its thread alone. After a failure no
/// further job starts.
template <class Body>
void parallel_tasks(int n, const Body& body) {
  run_parallel_tasks(n, numbered_job::of(body));
}

}  // namespace apsis
