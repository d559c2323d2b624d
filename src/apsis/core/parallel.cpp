#include <apsis/core/parallel.hpp>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <exception>
#include <limits>

#include <omp.h>

namespace apsis {
namespace {
int thread_count = 1;
}

void set_threads(int n) {
  thread_count = n > 0 ? n : omp_get_num_procs();
}

int threads() {
  return thread_count;
}

namespace {

/// The exception of the smallest k, to be thrown when all threads have stopped.
class first_failure {
 public:
  template <class Body>
  void guard(int k, const Body& body) {
    try {
      body(k);
    } catch (...) {
#pragma omp critical(apsis_parallel_failure)
      if (k < failed_at_) {
        failed_at_ = k;
        failure_ = std::current_exception();
      }
      any_ = true;
    }
  }
  bool any() const { return any_; }
  void rethrow() const {
    if (failure_) std::rethrow_exception(failure_);
  }

 private:
  std::exception_ptr failure_;
  int failed_at_ = std::numeric_limits<int>::max();
  std::atomic<bool> any_ = false;
};

}  // namespace

namespace {

/// Numbers that are left of the part of one thread; on a cache line of its own.
struct alignas(64) remaining {
  std::atomic<int> next;
  int end;
};
constexpr int most_threads = 256;

}  // namespace

void run_parallel_for(int n, numbered_job body) {
  const int team = std::min({thread_count, n, most_threads});
  if (team <= 1 || omp_in_parallel() != 0) {
    for (int k = 0; k < n; ++k) body(k);
    return;
  }
  // Every thread does its own part first, whose memory is near to it, and then helps the others: cores may be
  // of different speed, or do something else for a while. The last number of a part is left to its own
  // thread, which is about to come to it, or else short parts would wander between the caches.
  std::array<remaining, most_threads> parts;
  for (int p = 0; p < team; ++p) {
    const auto first = [&](int part) { return static_cast<int>(static_cast<long>(n) * part / team); };
    parts[static_cast<std::size_t>(p)].next = first(p);
    parts[static_cast<std::size_t>(p)].end = first(p + 1);
  }
  first_failure failure;
#pragma omp parallel num_threads(team)
  {
    const int own = omp_get_thread_num(), present = omp_get_num_threads();
    for (int p = 0; p < team; ++p) {
      const int whose = (own + p) % team;
      auto& part = parts[static_cast<std::size_t>(whose)];
      const int end = p > 0 && whose < present ? part.end - 1 : part.end;
      while (part.next.load(std::memory_order_relaxed) < end) {
        const int k = part.next++;
        if (k < part.end) failure.guard(k, body);
      }
    }
  }
  failure.rethrow();
}

part_blocks::part_blocks(int n, int longest, int parts) : n_(n), parts_(std::max(1, parts)) {
  const int length = (n_ + parts_ - 1) / parts_;
  whole_ = std::max(1, (length + longest - 1) / longest);
  // To begin a block costs something, so that small ones are not cut.
  const int last = length / whole_;
  pieces_ = parts_ == 1 || last < 32 ? 1 : last < 64 ? 2 : 4;
}

int part_blocks::begin(int block) const {
  // In eighths of a whole block: a half, a quarter and two eighths are the last one.
  static constexpr int eighths[] = {0, 4, 6, 7};
  const int part = block / per_part(), i = block % per_part();
  if (part == parts_) return n_;
  const int whole = std::min(i, whole_ - 1), at = 8 * whole + eighths[i - whole];
  const auto first = [this](int p) { return static_cast<int>(static_cast<long>(n_) * p / parts_); };
  return first(part) + static_cast<int>(static_cast<long>(first(part + 1) - first(part)) * at / (8 * whole_));
}

void run_parallel_tasks(int n, numbered_job body) {
  first_failure failure;
#pragma omp parallel for schedule(dynamic, 1) num_threads(std::max(1, std::min(thread_count, n)))
  for (int k = 0; k < n; ++k)
    if (!failure.any()) failure.guard(k, body);
  failure.rethrow();
}

}  // namespace apsis
