#pragma once

#include <apsis/exec/parallel.hpp>

#include <chrono>
#include <memory>

namespace apsis {

/// Position of a thread in a parallel region.
struct region_position {
  bool inside = false;  ///< whether in a region, where loops run on this thread alone
  int number = 0;       ///< index; 0 for the caller and outside regions
};
/// Returns the position of the calling thread.
region_position& this_thread_position();

/// Decides when the caller should run regions alone for a while. It compares the cost of parallel regions
/// with an estimate for the caller alone, because a worker preempted during a job delays the whole region.
class team_overhead {
 public:
  /// Timestamps of a region.
  struct times {
    std::chrono::steady_clock::time_point begun,  ///< before the workers are notified
        called,                                   ///< before the caller's share
        worked,                                   ///< after the caller's share
        ended;                                    ///< when all threads have finished
  };

  /// Records a region in which the caller ran `own` of n jobs.
  void add(const times& at, int own, int n);
  /// Whether regions should run on the caller alone at time `now`.
  bool backs_off(std::chrono::steady_clock::time_point now) const { return now < backoff_until_; }
  /// Whether regions should run on the caller alone now. Reads no clock before the first time of backing off.
  bool backs_off() const {
    return backoff_until_ != std::chrono::steady_clock::time_point() &&
           backs_off(std::chrono::steady_clock::now());
  }

 private:
  double debt_ = 0.0;  ///< time lost to waiting, in seconds; negative means time saved
  std::chrono::steady_clock::time_point backoff_until_{};
};

/// The threads of one caller: itself and workers that wait between parallel regions. The caller does not wait
/// for a preempted worker, but takes over its jobs. At the end of a region it waits only for workers that run
/// a job.
class thread_team {
 public:
  /// Distribution of the jobs 0 … n−1 of a region over the threads.
  enum class split {
    parts,      ///< each thread runs a contiguous part and then steals from the others
    one_by_one  ///< an idle thread takes the next job; none starts after a failure
  };

  /// Starts size − 1 workers, or as many as the system allows.
  explicit thread_team(int size);
  /// Dismisses the workers without waiting for them.
  ~thread_team();
  thread_team(const thread_team&) = delete;
  thread_team& operator=(const thread_team&) = delete;

  int size() const { return size_; }  ///< number of threads requested, including the caller
  /// Whether this process was forked from the one that started the workers.
  bool is_orphaned() const;

  /// Whether the workers have recently cost more time than they saved.
  bool backs_off() const { return overhead_.backs_off(); }

  /// Runs job(k) for k = 0 … n−1 with at most `threads` threads; rethrows the exception of the smallest
  /// k that failed.
  void run(int n, int threads, numbered_job job, split mode);

 private:
  struct shared;
  static void serve(const std::shared_ptr<shared>& with, int number);

  int size_, workers_ = 0;
  long forks_;
  std::shared_ptr<shared> shared_;
  team_overhead overhead_;
};

}  // namespace apsis
