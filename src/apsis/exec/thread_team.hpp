#pragma once

#include <apsis/exec/parallel.hpp>

#include <chrono>
#include <memory>

namespace apsis {

/// Where a thread stands among those of a parallel region.
struct place_in_region {
  bool inside = false;  ///< of a region: loops then run on this thread alone
  int number = 0;       ///< 0 for the caller, and outside of regions
};
/// That of the calling thread.
place_in_region& place_of_this_thread();

/// What regions cost, against an estimate of what the caller alone would have needed, and when it had better
/// work alone for a while: a worker that the machine stopped while it held a number is waited for.
class waiting_account {
 public:
  /// Times of a region.
  struct times {
    std::chrono::steady_clock::time_point begun,  ///< before workers were called
        called,                                   ///< before the caller's own work
        worked,                                   ///< after it
        ended;                                    ///< when all had finished
  };

  /// Notes a region of which the caller did `own` of n numbers.
  void add(const times& at, int own, int n);
  /// Whether the debts of before are still to be worked off.
  bool rests(std::chrono::steady_clock::time_point now) const { return now < rest_until_; }
  /// The same without a look at the clock where there was never a debt.
  bool rests() const {
    return rest_until_ != std::chrono::steady_clock::time_point() && rests(std::chrono::steady_clock::now());
  }

 private:
  double debt_ = 0.0;  ///< in seconds; below 0 a credit
  std::chrono::steady_clock::time_point rest_until_{};
};

/// The threads of one caller: itself and workers that wait for it between parallel regions. A worker that the
/// machine does not run is not waited for: the caller does its work, and at the end of a region waits only
/// for those that hold a part of it.
class thread_team {
 public:
  /// How the numbers 0 … n−1 of a region reach the threads.
  enum class split {
    parts,      ///< each thread has a part of neighbouring numbers and then helps the others
    one_by_one  ///< who is free takes the next number; none is begun after a failure
  };

  /// Starts size − 1 workers, or as many as the system grants.
  explicit thread_team(int size);
  /// Sends the workers away, without waiting for them.
  ~thread_team();
  thread_team(const thread_team&) = delete;
  thread_team& operator=(const thread_team&) = delete;

  int size() const { return size_; }  ///< threads asked for, the caller included
  /// Whether this process was forked since: the workers are then the parent's.
  bool left_behind() const;

  /// Whether the workers have lately cost more time than they saved.
  bool rests() const { return account_.rests(); }

  /// Runs the job for all numbers with at most `threads` threads; throws the exception of the smallest one
  /// that failed.
  void run(int n, int threads, numbered_job job, split how);

 private:
  struct shared;
  static void serve(const std::shared_ptr<shared>& with, int number);

  int size_, workers_ = 0;
  long forks_;
  std::shared_ptr<shared> shared_;
  waiting_account account_;
};

}  // namespace apsis
