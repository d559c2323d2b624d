#pragma once

#include <string>

namespace apsis {

/// Properties guaranteed by the configuration of a run. A broken promise ends the run (exit code 3).
struct run_promises {
  bool positivity = false;    ///< nonnegative data, limiter (or first-order upwind), Δt ≤ r Δt_FE
  bool conservation = false;  ///< with what crosses the faces, and Q implicit or Δt ≤ r Δt_FE
  bool entropy = false;       ///< positivity with first-order upwind, and ends that are periodic or walls
  std::string condition;      ///< of the model on the state (model::condition()); "" without one
  std::string why_signed;     ///< model::why_signed(); "" if the model keeps signs
  std::string text() const;   ///< returns one line for the log
};

}  // namespace apsis
