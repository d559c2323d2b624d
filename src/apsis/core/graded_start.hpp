#pragma once

#include <bit>
#include <limits>
#include <vector>

namespace apsis {

/// Default ratio of successive times of a graded start.
inline constexpr int default_growth = 2;
inline constexpr int largest_growth = 64;  ///< largest ratio of a graded start

/// Returns the longest first step that resolves a layer of the width `relaxation_time` (ε/C): growth/8 of
/// this width, or a quarter if the times double. Larger ratios suit methods of high order, which also need
/// fewer steps inside the layer.
template <class Real>
Real longest_first_step(const Real& relaxation_time, int growth) {
  return relaxation_time * Real(growth) / Real(8);
}

/// Returns how often dt must be divided by `growth` to be at most `shortest`; 0 if `shortest` is not
/// positive, because there is no layer for ε = 0. The divisor growth^levels is limited to about 2^(digits +
/// 2) with the binary digits of Real. The O(ε) effect of a thinner layer is below the rounding of one step.
template <class Real>
int graded_levels(Real dt, const Real& shortest, int growth) {
  const int halvings = static_cast<int>(std::bit_width(static_cast<unsigned>(growth))) - 1;
  int levels = 0;
  for (; dt > shortest && shortest > Real(0) && levels * halvings < std::numeric_limits<Real>::digits + 2;
       ++levels)
    dt /= Real(growth);
  return levels;
}

/// Returns the time at the end of step `k` (from 0) of a step dt that is divided at m = `levels` levels.
/// These times are dt/gᵐ, …, dt/g, dt with g = growth.
template <class Real>
Real graded_time(Real dt, long levels, long k, int growth) {
  for (long n = levels - k; n > 0; --n) dt /= Real(growth);
  return dt;
}

/// Returns step k (from 0) of a step dt that is divided at m levels. The first step is dt/gᵐ; every later
/// step is g − 1 times the time at its beginning. The steps thus resolve layers of all widths between the
/// first step and dt equally well. The times are exact if g is a power of two.
template <class Real>
Real graded_step(const Real& dt, long levels, long k, int growth) {
  const Real end = graded_time(dt, levels, k, growth);
  return k == 0 ? end : Real(end - graded_time(dt, levels, k - 1, growth));
}

/// Returns the graded steps that replace the first step dt. The number m of levels is the smallest one with a
/// first step of at most longest_first_step(), within the limit of graded_levels(). Returns {dt} if dt is
/// short enough. An initial layer of the width `relaxation_time` takes about log(8 dt/(g
/// relaxation_time))/log(g) additional steps. All times are dimensionless.
template <class Real>
std::vector<Real> graded_start(Real dt, const Real& relaxation_time, int growth = default_growth) {
  const int levels = graded_levels(dt, longest_first_step(relaxation_time, growth), growth);
  std::vector<Real> steps;
  for (int k = 0; k <= levels; ++k) steps.push_back(graded_step(dt, levels, k, growth));
  return steps;
}

}  // namespace apsis
