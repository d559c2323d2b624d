// Thread teams: preempted workers, exceptions, forks, and per-thread data.
#include <apsis/exec/thread_team.hpp>

#include <apsis/core/errors.hpp>
#include <apsis/exec/parallel.hpp>
#include <apsis/exec/processors.hpp>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdlib>
#include <mutex>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

namespace thread_team_test {

namespace {

/// Sets the number of threads for a test, and resets it to 1 afterwards.
struct with_threads {
  explicit with_threads(int n) { apsis::set_threads(n); }
  ~with_threads() { apsis::set_threads(1); }
  with_threads(const with_threads&) = delete;
  with_threads& operator=(const with_threads&) = delete;
};

long sum_in_parallel(int n) {
  std::vector<long> squares(static_cast<std::size_t>(n));
  apsis::parallel_for(n, [&](int k) { squares[static_cast<std::size_t>(k)] = static_cast<long>(k) * k; });
  long sum = 0;
  for (const long square : squares) sum += square;
  return sum;
}

}  // namespace

TEST(thread_team, runs_every_job_exactly_once_in_repeated_regions) {
  for (const int threads : {2, 3, 7}) {
    const with_threads some(threads);
    for (int region = 0; region < 3000; ++region) {
      const int n = 1 + region % 23;
      std::vector<int> seen(static_cast<std::size_t>(n), 0);  // no atomics: an entry is written by one thread
      apsis::parallel_for(n, [&](int k) { ++seen[static_cast<std::size_t>(k)]; });
      for (const int count : seen) ASSERT_EQ(count, 1) << threads << " " << region;
    }
  }
}

TEST(thread_team, rethrows_the_exception_of_the_smallest_index_and_remains_usable) {
  const with_threads three(3);
  for (int round = 0; round < 200; ++round) {
    try {
      apsis::parallel_for(40, [](int k) {
        if (k % 7 == 3) throw std::runtime_error(std::to_string(k));
      });
      FAIL() << "nothing was thrown";
    } catch (const std::runtime_error& failure) {
      EXPECT_STREQ(failure.what(), "3");
    }
    EXPECT_EQ(sum_in_parallel(100), 328350);
  }
}

TEST(thread_team, caller_takes_over_the_jobs_of_idle_workers) {
  // A job that a worker runs ends only when all other jobs are done. The other thread must take them over.
  const with_threads two(2);
  constexpr int n = 64;
  std::mutex mutex;
  std::condition_variable changed;
  int done = 0;
  apsis::parallel_for(n, [&](int) {
    std::unique_lock lock(mutex);
    ++done;
    changed.notify_all();
    if (apsis::thread_number() == 1) changed.wait(lock, [&] { return done == n; });
  });
  EXPECT_EQ(done, n);
}

TEST(thread_team, nested_loops_run_on_the_calling_thread) {
  const with_threads two(2);
  std::atomic<int> inner = 0;
  apsis::parallel_tasks(6, [&](int) {
    EXPECT_EQ(apsis::threads_here(), 1);
    const auto here = std::this_thread::get_id();
    apsis::parallel_for(10, [&](int) {
      EXPECT_EQ(std::this_thread::get_id(), here);
      EXPECT_EQ(apsis::thread_number(), 0);
      ++inner;
    });
  });
  EXPECT_EQ(inner, 60);
  EXPECT_EQ(apsis::threads_here(), 2);
  EXPECT_EQ(apsis::thread_number(), 0);
}

TEST(thread_team, concurrent_callers_are_independent) {
  const with_threads two(2);
  std::vector<std::thread> callers;
  std::atomic<int> right = 0;
  for (int caller = 0; caller < 4; ++caller)
    callers.emplace_back([&] {
      for (int round = 0; round < 100; ++round)
        if (sum_in_parallel(200) == 2646700) ++right;
    });
  for (auto& caller : callers) caller.join();
  EXPECT_EQ(right, 400);
}

TEST(thread_team, starts_no_further_tasks_after_a_failure) {
  std::atomic<int> begun = 0;
  const auto job = [&](int k) {
    ++begun;
    if (k == 3) throw std::runtime_error("fourth");
  };
  const auto failure = [&job]() -> std::string {
    try {
      apsis::parallel_tasks(1000, job);
    } catch (const std::runtime_error& thrown) {
      return thrown.what();
    }
    return "none";
  };
  EXPECT_EQ(failure(), "fourth");
  EXPECT_EQ(begun, 4);
  const with_threads two(2);
  EXPECT_EQ(failure(), "fourth");
}

TEST(thread_team, forked_child_creates_its_own_threads) {
  const with_threads two(2);
  const long expected = sum_in_parallel(1000);  // starts the workers of the parent
  for (int round = 0; round < 20; ++round) {
    const pid_t child = fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      bool same = true;
      for (int k = 0; k < 20; ++k) same = same && sum_in_parallel(1000) == expected;
      std::_Exit(same ? 0 : 1);
    }
    int status = 0;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
    EXPECT_EQ(sum_in_parallel(1000), expected);
  }
}

TEST(team_overhead, backs_off_for_twelve_times_the_waiting_time) {
  using account = apsis::team_overhead;
  using std::chrono::microseconds;
  const std::chrono::steady_clock::time_point start(microseconds(1'000'000));
  const auto region = [&](long work, long wait) {
    return account::times{start, start, start + microseconds(work), start + microseconds(work + wait)};
  };
  account lucky, unlucky, idle;
  for (int k = 0; k < 1000; ++k) lucky.add(region(100, 10), 5, 10);  // sequential: 200 µs
  lucky.add(region(100, 450), 5, 10);
  EXPECT_FALSE(lucky.backs_off(start)) << "350 µs lost, minus a credit of 200 µs";
  unlucky.add(region(100, 6100), 5, 10);
  EXPECT_TRUE(unlucky.backs_off(start + microseconds(6200 + 12 * 6000 - 1)));
  EXPECT_FALSE(unlucky.backs_off(start + microseconds(6200 + 12 * 6000 + 1)));
  for (int k = 0; k < 30; ++k) idle.add(region(100, 5), 10, 10);  // workers do not wake up
  EXPECT_FALSE(idle.backs_off(start));
  for (int k = 0; k < 30; ++k) idle.add(region(100, 5), 10, 10);
  EXPECT_TRUE(idle.backs_off(start + microseconds(1000)));
  idle = account();
  idle.add(region(0, 9000), 0, 10);
  EXPECT_FALSE(idle.backs_off(start)) << "workers did everything";
}

TEST(per_thread, is_prepared_for_all_threads_before_the_loop) {
  const with_threads four(4);
  apsis::per_thread<std::vector<double>> scratch;
  int prepared = 0;
  scratch.prepare([&](auto& numbers) {
    numbers.reserve(100);
    ++prepared;
  });
  EXPECT_EQ(prepared, 4);
  std::atomic<int> with_room = 0;
  apsis::parallel_for(64, [&](int) {
    if (scratch.here().capacity() >= 100) ++with_room;
  });
  EXPECT_EQ(with_room, 64);
}

TEST(threads, outside_the_valid_range_are_rejected) {
  for (const int n : {-1, apsis::most_threads + 1, 1000000}) {
    try {
      apsis::set_threads(n);
      FAIL() << n;
    } catch (const apsis::input_error& refused) {
      EXPECT_NE(std::string(refused.what()).find(std::to_string(n) + " threads cannot be used (1 to 256"),
                std::string::npos)
          << refused.what();
    }
    EXPECT_EQ(apsis::threads(), 1);
  }
  const with_threads all(0);
  EXPECT_EQ(apsis::threads(), std::min(apsis::available_processors(), apsis::most_threads));
}

TEST(processors, granted_by_a_quota_are_rounded_up) {
  EXPECT_EQ(apsis::processors_of_quota("max 100000"), 0);
  EXPECT_EQ(apsis::processors_of_quota(""), 0);
  EXPECT_EQ(apsis::processors_of_quota("200000 100000"), 2);
  EXPECT_EQ(apsis::processors_of_quota("150000 100000"), 2);
  EXPECT_EQ(apsis::processors_of_quota("50000 100000"), 1);
  EXPECT_EQ(apsis::processors_of_quota("0 100000"), 0);
  EXPECT_EQ(apsis::processors_of_quota("100000 0"), 0);
}

}  // namespace thread_team_test
