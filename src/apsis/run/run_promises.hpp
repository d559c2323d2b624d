#pragma once

#include <string>

namespace apsis {

/// Properties guaranteed by the configuration of a run, with their conditions. A broken promise ends
/// the run (exit code 3).
struct run_promises {
  bool positivity = false;    ///< nonnegative data, limiter (or first-order upwind), Δt ≤ r Δt_FE
  bool conservation = false;  ///< up to fluxes through the faces; Q implicit or Δt ≤ r Δt_FE
  bool entropy = false;       ///< positivity, first-order upwind, boundaries periodic or walls
  std::string condition;      ///< condition of the model on the state (model::condition()); "" without one
  std::string why_signed;     ///< model::why_signed(); "" if the model keeps signs
  std::string text() const;   ///< returns one line for the log
};

}  // namespace apsis
