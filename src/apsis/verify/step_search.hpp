#pragma once

#include <cstddef>
#include <functional>
#include <limits>

namespace apsis {

/// Parameters of the search for the largest step that preserves a property. Such steps need not form an
/// interval. The search therefore climbs a ladder of steps from the smallest one, and bisects only the
/// interval of the first loss.
struct step_search {
  int steps = 1;           ///< steps from each of the data
  bool stages = false;     ///< whether stage values must also preserve the property
  double lowest = 0.0625;  ///< first rung, in units of Δt_FE
  double highest = 16.0;   ///< last rung
  double rung = 1.1;       ///< ratio of consecutive rungs
  double accuracy = 1e-4;  ///< relative accuracy of the bisection
  double promised = 0.0;   ///< if positive, tested too, so that the bisection does not end just below it
  double unit = 0.0;       ///< if positive, replaces Δt_FE
};

/// Result of a search; steps in units of Δt_FE.
struct step_limit {
  double kept = 0.0;  ///< the property is preserved here and on all rungs below; 0 if it is lost on the first
  double lost = std::numeric_limits<double>::infinity();  ///< the smallest tested step that loses it
  std::size_t data = 0;                                   ///< index of the data that lose it there
  double excess = 0.0;                                    ///< the excess there
  double unit = 1.0;                                      ///< Δt_FE
};

/// Performs the search of largest_step: excess(k, dt) ≤ 0 if data k preserve the property with dt. Throws
/// input_error if count is 0 or the unit is not a positive number.
step_limit search_step(std::size_t count, double unit, const step_search& how,
                       const std::function<double(std::size_t, double)>& excess);

}  // namespace apsis
