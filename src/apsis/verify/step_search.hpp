#pragma once

#include <cstddef>
#include <functional>
#include <limits>

namespace apsis {

/// How the largest step that keeps a property is looked for. The steps that keep it need not be an interval,
/// so a ladder of steps is climbed from the smallest one, and only the rung of the first loss is bisected.
struct step_search {
  int steps = 1;           ///< taken from each of the data
  bool stages = false;     ///< whether stage values must keep the property as well
  double lowest = 0.0625;  ///< first rung, in units of Δt_FE
  double highest = 16.0;   ///< last rung
  double rung = 1.1;       ///< ratio of neighbours
  double accuracy = 1e-4;  ///< of the bisection, relative
  double promised = 0.0;   ///< if positive, tried itself, so that the bisection does not end just below it
  double unit = 0.0;       ///< if positive, in place of Δt_FE
};

/// What was found; steps in units of Δt_FE.
struct step_limit {
  double kept = 0.0;  ///< the property is kept here and on all rungs below; 0 if it is lost on the first
  double lost = std::numeric_limits<double>::infinity();  ///< the nearest step found that loses it
  std::size_t data = 0;                                   ///< which of the data lose it there
  double excess = 0.0;                                    ///< and by how much
  double unit = 1.0;                                      ///< Δt_FE
};

/// The search behind largest_step: excess(k, dt) ≤ 0 if data k keep the property with dt. Throws input_error
/// if count is 0 or the unit is not a positive number.
step_limit search_step(std::size_t count, double unit, const step_search& how,
                       const std::function<double(std::size_t, double)>& excess);

}  // namespace apsis
