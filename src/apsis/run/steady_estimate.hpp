#pragma once

#include <apsis/output/table.hpp>

#include <limits>
#include <string>

namespace apsis {

/// Rate of change of a state, which time.steady bounds, and its estimated distance from the steady state.
/// A small rate alone does not mean a small distance: they differ by the time in which the change decays.
struct steady_estimate {
  /// NaN, for a number that cannot be estimated.
  static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  double change = unknown,   ///< ‖u^{n+1} − u^n‖₂/(Δt ‖u^{n+1}‖₂) of the last step
      decay_time = unknown,  ///< τ of change ∝ exp(−t/τ); NaN if the change has not halved, or grows
      distance = unknown;    ///< change · τ: ‖u(∞) − u‖₂/‖u‖₂ if the change decays on as it did
  /// Whether the distance is known.
  bool has_distance() const { return decay_time > 0.0; }
};

/// Estimates it from the columns t and change of a history: τ is that of the regression line of ln(change)
/// since the change was last twice the present one.
steady_estimate estimate_steady_state(const numeric_table& history);

/// Returns one line: "the state changes by 1e-05 per unit of time; …", in the unit of time `factor` with the
/// name `unit`, as in " s".
std::string to_text(const steady_estimate& estimate, double factor = 1.0, const std::string& unit = "");

}  // namespace apsis
