#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

/// Solves a system with this diagonal and equal entries `other` beside it: x ← its solution for r, by
/// elimination without exchanges.
inline void eliminate(std::vector<double> diagonal, double other, std::span<const double> r,
                      std::span<double> x) {
  std::copy(r.begin(), r.end(), x.begin());
  for (std::size_t i = 1; i < x.size(); ++i) {
    const double factor = other / diagonal[i - 1];
    diagonal[i] -= factor * other;
    x[i] -= factor * x[i - 1];
  }
  for (std::size_t i = x.size(); i-- > 0;) {
    if (i + 1 < x.size()) x[i] -= other * x[i + 1];
    x[i] /= diagonal[i];
  }
}
