#include <apsis/core/parallel.hpp>

#include <algorithm>
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

void parallel_for(int n, const std::function<void(int)>& body) {
  const int team = std::min(thread_count, n);
  if (team <= 1 || omp_in_parallel() != 0) {
    for (int k = 0; k < n; ++k) body(k);
    return;
  }
  std::exception_ptr failure;
  int failed_at = std::numeric_limits<int>::max();
#pragma omp parallel for schedule(static) num_threads(team)
  for (int k = 0; k < n; ++k) {
    try {
      body(k);
    } catch (...) {
#pragma omp critical(apsis_parallel_failure)
      if (k < failed_at) {
        failed_at = k;
        failure = std::current_exception();
      }
    }
  }
  if (failure) std::rethrow_exception(failure);
}

}  // namespace apsis
