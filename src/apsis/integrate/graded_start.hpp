#pragma once

#include <limits>
#include <vector>

namespace apsis {

/// Returns how often dt must be halved to be at most `shortest`; at most the number of digits of Real plus
/// two, because the O(ε) effect of a thinner layer is below the rounding of one step. 0 if `shortest` is not
/// positive: for ε = 0 there is no layer.
template <class Real>
int graded_levels(Real dt, const Real& shortest) {
  int levels = 0;
  for (; dt > shortest && shortest > Real(0) && levels < std::numeric_limits<Real>::digits + 2; ++levels)
    dt /= 2;
  return levels;
}

/// Returns x/2ⁿ.
template <class Real>
Real halved(Real x, long n) {
  for (; n > 0; --n) x /= 2;
  return x;
}

/// Returns step k (from 0) of a step dt divided into m levels: dt/2^m, dt/2^m, dt/2^(m−1), …, dt/2. Each
/// step is as long as the time before it, so that layers of all widths between the first step and dt are
/// resolved equally well.
template <class Real>
Real graded_step(const Real& dt, long levels, long k) {
  return halved(dt, k == 0 ? levels : levels + 1 - k);
}

/// Returns the graded steps that replace the first step dt, for the smallest m for which the first is
/// not longer than `shortest` (with the limit of graded_levels); {dt} if dt is short enough. They
/// resolve an initial layer of width ε/C if `shortest` is about ε/(4C), at the cost of log₂(dt/shortest)
/// additional steps. Dimensionless.
template <class Real>
std::vector<Real> graded_start(Real dt, Real shortest) {
  const int levels = graded_levels(dt, shortest);
  std::vector<Real> steps;
  for (int k = 0; k <= levels; ++k) steps.push_back(graded_step(dt, levels, k));
  return steps;
}

}  // namespace apsis
