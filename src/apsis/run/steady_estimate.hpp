#pragma once

#include <apsis/output/table.hpp>

#include <limits>
#include <string>

namespace apsis {

/// Rate of change of a state, which time.steady bounds, and its estimated distance from the steady
/// state. The distance is the rate times the time in which the change decays. A small rate alone does
/// not imply a small distance.
struct steady_estimate {
  /// NaN, for a number that cannot be estimated.
  static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  double change = unknown,   ///< ‖u^{n+1} − u^n‖₂/(Δt ‖u^{n+1}‖₂) of the last step
      decay_time = unknown,  ///< τ of change ∝ exp(−t/τ); NaN if the change has not halved, or grows
      distance = unknown;    ///< change · τ: ‖u(∞) − u‖₂/‖u‖₂ if the decay continues
  /// Returns whether the distance is known.
  bool has_distance() const { return decay_time > 0.0; }
};

/// Estimates rate, decay time and distance from the columns t and change of a history. τ is that of the
/// regression line of ln(change), from the last time at which the change was twice the present one.
steady_estimate estimate_steady_state(const numeric_table& history);

/// Returns one line: "the state changes by 1e-05 per unit of time; …". Times are multiplied by `factor` and
/// have the unit `unit`, such as " s".
std::string to_text(const steady_estimate& estimate, double factor = 1.0, const std::string& unit = "");

}  // namespace apsis
