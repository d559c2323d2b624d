#include <apsis/core/parallel.hpp>

#include <algorithm>
#include <atomic>
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

void run_parallel_for(int n, numbered_job body) {
  const int team = std::min(thread_count, n);
  if (team <= 1 || omp_in_parallel() != 0) {
    for (int k = 0; k < n; ++k) body(k);
    return;
  }
  first_failure failure;
#pragma omp parallel for schedule(static) num_threads(team)
  for (int k = 0; k < n; ++k) failure.guard(k, body);
  failure.rethrow();
}

void run_parallel_tasks(int n, numbered_job body) {
  first_failure failure;
#pragma omp parallel for schedule(dynamic, 1) num_threads(std::max(1, std::min(thread_count, n)))
  for (int k = 0; k < n; ++k)
    if (!failure.any()) failure.guard(k, body);
  failure.rethrow();
}

}  // namespace apsis
