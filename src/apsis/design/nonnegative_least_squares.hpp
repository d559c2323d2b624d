#pragma once

#include <vector>

#include <Eigen/Dense>

namespace apsis {

/// Returns the x ≥ 0 that minimizes ‖A x − b‖₂, by the active-set method of Lawson and Hanson (Solving Least
/// Squares Problems, 1974, chapter 23). Columns with positive x are linearly independent, so x is sparse. A:
/// m × n, b: m. Gradients up to `zero` count as zero.
template <class Real>
Eigen::Vector<Real, Eigen::Dynamic> nonnegative_least_squares(
    const Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>& A,
    const Eigen::Vector<Real, Eigen::Dynamic>& b, const Real& zero) {
  using vector = Eigen::Vector<Real, Eigen::Dynamic>;
  const Eigen::Index n = A.cols();
  std::vector<Eigen::Index> positive;
  vector x = vector::Zero(n);
  // In exact arithmetic the iteration is finite; with rounding a column may enter and leave repeatedly.
  for (Eigen::Index iteration = 0; iteration < 10 * n; ++iteration) {
    const vector gradient = A.transpose() * (b - A * x);
    Eigen::Index steepest = -1;
    for (Eigen::Index j = 0; j < n; ++j)
      if (x(j) == Real(0) && gradient(j) > zero && (steepest < 0 || gradient(j) > gradient(steepest)))
        steepest = j;
    if (steepest < 0) return x;
    positive.push_back(steepest);
    while (!positive.empty()) {
      const vector best = A(Eigen::all, positive).colPivHouseholderQr().solve(b);
      Real step(1);  // fraction of the way from x to the unconstrained minimum
      std::size_t blocking = positive.size();
      for (std::size_t k = 0; k < positive.size(); ++k) {
        const Real from = x(positive[k]), to = best(static_cast<Eigen::Index>(k));
        if (to > Real(0) || from >= step * (from - to)) continue;
        step = from / (from - to);
        blocking = k;
      }
      const bool inside = blocking == positive.size();
      std::vector<Eigen::Index> kept;
      for (std::size_t k = 0; k < positive.size(); ++k) {
        Real& value = x(positive[k]);
        value += step * (best(static_cast<Eigen::Index>(k)) - value);
        // The blocking entry is zero, whatever its step rounds to, so that every round removes an entry.
        if (k == blocking || value <= Real(0)) {
          value = Real(0);
        } else {
          kept.push_back(positive[k]);
        }
      }
      positive = kept;
      if (inside) break;
    }
  }
  return x;
}

}  // namespace apsis
