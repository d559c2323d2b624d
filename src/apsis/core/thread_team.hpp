#pragma once

#include <apsis/core/parallel.hpp>

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

  /// Whether the workers have lately cost more time than they saved, so that the caller had better work alone
  /// for a while: a worker that the machine stopped while it held a number is waited for.
  bool rests() const { return account_.rests(); }

  /// Runs the job for all numbers with at most `threads` threads; throws the exception of the smallest one
  /// that failed.
  void run(int n, int threads, numbered_job job, split how);

 private:
  using clock = std::chrono::steady_clock;
  struct region_times {
    clock::time_point begun, called, worked, ended;
  };
  /// What regions cost against an estimate of what the caller alone would have needed.
  class account {
   public:
    bool rests() const { return rest_until_ != clock::time_point() && clock::now() < rest_until_; }
    /// The caller did `own` of n numbers.
    void add(const region_times& at, int own, int n);

   private:
    double debt_ = 0.0;  ///< in seconds; below 0 a credit
    clock::time_point rest_until_{};
  };

  struct shared;
  static void serve(const std::shared_ptr<shared>& with, int number);

  int size_, workers_ = 0;
  long forks_;
  std::shared_ptr<shared> shared_;
  account account_;
};

}  // namespace apsis
