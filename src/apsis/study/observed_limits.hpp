#pragma once

#include <apsis/method/method.hpp>
#include <apsis/study/study_control.hpp>
#include <apsis/verify/step_search.hpp>

#include <cmath>
#include <string>
#include <vector>

namespace apsis {

/// The largest observed step for which a method preserves a property, in units of Δt_FE.
struct observed_limit {
  std::string problem;    ///< "upwind advection"
  std::string property;   ///< "total variation"
  double promised = 0.0;  ///< the SSP coefficient of the method
  step_limit limit;       ///< largest step in the worst case
  std::string worst;      ///< worst value of the varied parameter: "epsilon = 0.1"

  /// Returns whether nothing was lost below the promised step (within the accuracy and range of the search).
  bool keeps_promise() const { return limit.kept >= (1.0 - 2e-3) * promised || std::isinf(limit.lost); }
};

/// Searches for the largest steps of any method, of the catalogue or not. The problems are adversarial ones,
/// and every model of the registry with space that has an entropy or positive unknowns, for ε from 0 to 1e12.
/// Implicit methods are tested on u' = −10u² instead. Deterministic; some tenths of a second per stage.
std::vector<observed_limit> observe_limits(const method& m, const study_control& control = {});

}  // namespace apsis
