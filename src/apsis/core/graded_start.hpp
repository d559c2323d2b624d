#pragma once

#include <bit>
#include <limits>
#include <vector>

namespace apsis {

/// Ratio of successive times of a graded start: 2 unless another is given.
inline constexpr int default_growth = 2;
inline constexpr int largest_growth = 64;  ///< largest ratio of a graded start

/// Returns the longest first step that resolves a layer of the width `relaxation_time` (ε/C): growth/8 of it,
/// a quarter where the times double. Larger ratios are for methods of high order, which need fewer steps in
/// the layer too.
template <class Real>
Real longest_first_step(const Real& relaxation_time, int growth) {
  return relaxation_time * Real(growth) / Real(8);
}

/// Returns how often dt must be divided by `growth` to be at most `shortest`; at most as often as halves have
/// digits of Real plus two, because the O(ε) effect of a thinner layer is below the rounding of one step. 0
/// if `shortest` is not positive: for ε = 0 there is no layer.
template <class Real>
int graded_levels(Real dt, const Real& shortest, int growth) {
  const int halvings = static_cast<int>(std::bit_width(static_cast<unsigned>(growth))) - 1;
  int levels = 0;
  for (; dt > shortest && shortest > Real(0) && levels * halvings < std::numeric_limits<Real>::digits + 2;
       ++levels)
    dt /= Real(growth);
  return levels;
}

/// Returns the time after `k` + 1 of the steps into which a step dt is divided at m levels: dt/gᵐ, …, dt/g,
/// dt with g = growth.
template <class Real>
Real graded_time(Real dt, long levels, long k, int growth) {
  for (long n = levels - k; n > 0; --n) dt /= Real(growth);
  return dt;
}

/// Returns step k (from 0) of a step dt divided at m levels: dt/gᵐ, and then g − 1 times the time before the
/// step, so that layers of all widths between the first step and dt are resolved equally well. The times of g
/// = 2 and other powers of two are exact.
template <class Real>
Real graded_step(const Real& dt, long levels, long k, int growth) {
  const Real end = graded_time(dt, levels, k, growth);
  return k == 0 ? end : Real(end - graded_time(dt, levels, k - 1, growth));
}

/// Returns the graded steps that replace the first step dt, for the smallest m for which the first is at most
/// longest_first_step() (with the limit of graded_levels); {dt} if dt is short enough. They resolve an
/// initial layer of the width `relaxation_time` with about log(8 dt/(g relaxation_time))/log(g) more steps.
/// Dimensionless.
template <class Real>
std::vector<Real> graded_start(Real dt, const Real& relaxation_time, int growth = default_growth) {
  const int levels = graded_levels(dt, longest_first_step(relaxation_time, growth), growth);
  std::vector<Real> steps;
  for (int k = 0; k <= levels; ++k) steps.push_back(graded_step(dt, levels, k, growth));
  return steps;
}

}  // namespace apsis
