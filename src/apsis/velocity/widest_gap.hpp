#pragma once

namespace apsis {

/// Returns the largest distance between neighbours among n ascending velocities, or `least` if that is
/// larger. Only pairs whose interval overlaps the range `from` … `to` count. This header includes nothing,
/// because kernels of devices use it.
constexpr double widest_gap(const double* v, int n, double least, double from, double to) {
  double widest = least;
  for (int j = 1; j < n; ++j) {
    const double gap = v[j] - v[j - 1];
    if (v[j] > from && v[j - 1] < to && widest < gap) widest = gap;
  }
  return widest;
}

}  // namespace apsis
