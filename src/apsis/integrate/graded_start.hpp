#pragma once

#include <vector>

namespace apsis {

/// The first step dt cut into steps that double: dt/2^m, dt/2^m, dt/2^(m−1), …, dt/2, with the smallest m for
/// which the first is not longer than `shortest`. They resolve an initial layer of width ε/C if `shortest` is
/// about ε/(4C), with log₂(dt/shortest) more steps. Only {dt} if it is short enough. Dimensionless.
template <class Real>
std::vector<Real> graded_start(Real dt, Real shortest) {
  std::vector<Real> reversed;
  while (dt > shortest && shortest > Real(0)) {
    dt /= 2;
    reversed.push_back(dt);
  }
  reversed.push_back(dt);
  return {reversed.rbegin(), reversed.rend()};
}

}  // namespace apsis
