#pragma once

#include <apsis/method/method.hpp>
#include <apsis/verify/step_search.hpp>
#include <apsis/verify/study_control.hpp>

#include <cmath>
#include <string>
#include <vector>

namespace apsis {

/// The largest step for which a method was seen to keep a property, in units of Δt_FE.
struct observed_limit {
  std::string problem;    ///< "upwind advection"
  std::string property;   ///< "total variation"
  double promised = 0.0;  ///< the SSP coefficient of the method
  step_limit limit;       ///< what was found, in the worst case
  std::string worst;      ///< what was varied and was worst: "epsilon = 0.1"

  /// Nothing was lost below the promised step (to the accuracy of the search, and as far as it went).
  bool keeps_promise() const { return limit.kept >= (1.0 - 2e-3) * promised || std::isinf(limit.lost); }
};

/// Looks for the largest steps of any method, of the catalogue or not: on problems made to be bad for it, and
/// on every model of the registry with space that has an entropy or must stay positive, for ε from 0 to 1e12.
/// For implicit methods on u' = −10u². Deterministic; some tenths of a second per stage.
std::vector<observed_limit> observe_limits(const method& m, const study_control& control = {});

}  // namespace apsis
