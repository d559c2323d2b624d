#pragma once

#include <limits>
#include <vector>

namespace apsis {

/// How often dt is halved until it is at most `shortest`. At most as often as Real has digits, and two more:
/// the O(ε) that a thinner layer moves is below the rounding of one step. 0 if `shortest` is not positive:
/// there is no layer for ε = 0.
template <class Real>
int graded_levels(Real dt, const Real& shortest) {
  int levels = 0;
  for (; dt > shortest && shortest > Real(0) && levels < std::numeric_limits<Real>::digits + 2; ++levels)
    dt /= 2;
  return levels;
}

/// x/2ⁿ.
template <class Real>
Real halved(Real x, long n) {
  for (; n > 0; --n) x /= 2;
  return x;
}

/// Step k (from 0) of a step dt cut at m levels: dt/2^m, dt/2^m, dt/2^(m−1), …, dt/2. Each is as long as the
/// time before it, so layers of all widths between the first step and dt are resolved equally well.
template <class Real>
Real graded_step(const Real& dt, long levels, long k) {
  return halved(dt, k == 0 ? levels : levels + 1 - k);
}

/// The first step dt cut into steps that double, with the smallest m for which the first is not longer than
/// `shortest` (graded_levels says when it may be). They resolve an initial layer of width ε/C if `shortest`
/// is about ε/(4C), with log₂(dt/shortest) more steps. Only {dt} if it is short enough. Dimensionless.
template <class Real>
std::vector<Real> graded_start(Real dt, Real shortest) {
  const int levels = graded_levels(dt, shortest);
  std::vector<Real> steps;
  for (int k = 0; k <= levels; ++k) steps.push_back(graded_step(dt, levels, k));
  return steps;
}

}  // namespace apsis
