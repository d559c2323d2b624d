#pragma once

#include <apsis/mesh/field.hpp>
#include <apsis/run/setup.hpp>
#include <apsis/run/simulation.hpp>

namespace apsis {

/// Steps in time of a steady run whose iteration failed: their end is the start of the next attempt. Method
/// and limiter are those that a case without [time] gets. Members are collective.
class interim_march {
 public:
  /// `start`: the state at the beginning. Throws input_error where the case cannot run in time, or the memory
  /// does not suffice.
  interim_march(const run_setup& setup, const field& start, double duration);

  /// Advances by a twentieth of the duration; u ← the state. Throws numerical_error as simulation::advance().
  void advance(field& u);
  bool finished() const { return run_.finished(); }  ///< whether the duration is over
  double t() const { return run_.t(); }              ///< time since the beginning

 private:
  double part_;  ///< of the duration
  simulation run_;
};

}  // namespace apsis
