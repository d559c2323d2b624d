#pragma once

namespace apsis {

/// Threads that loops over cells may use; 0 asks for all cores.
void set_threads(int n);
/// The number that was set, 1 at the beginning.
int threads();

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
/// parallel_for, compiled once.
void run_parallel_for(int n, numbered_job job);
/// parallel_tasks, compiled once.
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
