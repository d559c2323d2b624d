#pragma once

#include <vector>

#include <Eigen/Dense>

namespace apsis {

/// The x ≥ 0 with the least ‖A x − b‖₂, by the active-set method of Lawson and Hanson (Solving Least Squares
/// Problems, 1974, chapter 23): the columns whose x is positive are independent, so x has few entries.
/// A: m × n, b: m. `zero`: a gradient up to this size is none.
template <class Real>
Eigen::Vector<Real, Eigen::Dynamic> nonnegative_least_squares(
    const Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>& A,
    const Eigen::Vector<Real, Eigen::Dynamic>& b, const Real& zero) {
  using vector = Eigen::Vector<Real, Eigen::Dynamic>;
  const Eigen::Index n = A.cols();
  std::vector<Eigen::Index> positive;
  vector x = vector::Zero(n);
  // A column enters for good at most once in exact arithmetic; rounding may make it enter and leave for ever.
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
      Real step(1);  // of the way from x to the best point without bounds
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
        // The one that blocks is zero, whatever its step rounds to; so every round takes one out.
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
