#pragma once

namespace apsis {

/// Returns the largest distance of two neighbours of n ascending velocities, or `least` if that is larger.
/// Pairs count whose interval has a part of the range from … to. This header includes nothing, as kernels of
/// devices need it.
constexpr double widest_gap(const double* v, int n, double least, double from, double to) {
  double widest = least;
  for (int j = 1; j < n; ++j) {
    const double gap = v[j] - v[j - 1];
    if (v[j] > from && v[j - 1] < to && widest < gap) widest = gap;
  }
  return widest;
}

}  // namespace apsis
