#pragma once

#include <apsis/method/method.hpp>

#include <algorithm>
#include <cmath>

namespace apsis {

/// How the error of a step of a method is estimated: W times the distance between two solutions, which is of
/// size Δt^{q+1}.
///
/// A method with an embedded solution of order q compares u^{n+1} with this solution, and W is the weight of
/// its certificate. Any other method of order p doubles steps: it takes one step and two of half its length
/// and compares their results. It continues with the result of the two. Then q = p, and W = 1/(2^p − 1), the
/// share of the two steps in the difference (Hairer, Nørsett, Wanner, Solving Ordinary Differential Equations
/// I, section II.4). Stiff components of implicit methods may converge with order 2 only, for which that
/// share is 1/3. Therefore W is at least 1/3 unless the method is explicit.
struct step_estimate {
  bool doubles;   ///< whether steps are doubled
  int order;      ///< q
  double weight;  ///< W
};

/// Returns how the error of a step of m is estimated.
inline step_estimate estimate_of(const method& m) {
  if (m.embedded) return {false, m.embedded->order, m.embedded->weight};
  const int p = m.claims.order;
  const int slowest = m.kind == method_kind::explicit_only ? p : std::min(p, 2);
  return {true, p, 1.0 / (std::exp2(slowest) - 1.0)};
}

}  // namespace apsis
