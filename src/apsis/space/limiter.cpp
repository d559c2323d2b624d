#include <apsis/space/limiter.hpp>

#include <algorithm>

namespace apsis::limiter {

void apply(const double* c, int width, double* left, double* right) {
#pragma omp simd
  for (int k = 0; k < width; ++k) {
    const double lowest = std::min(std::min(left[k], right[k]), interior(c[k], left[k], right[k]));
    const double theta = scaling(c[k], lowest);
    left[k] = c[k] + theta * (left[k] - c[k]);
    right[k] = c[k] + theta * (right[k] - c[k]);
  }
}

}  // namespace apsis::limiter
