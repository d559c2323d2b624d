#pragma once

#include <apsis/mesh/field.hpp>
#include <apsis/run/setup.hpp>
#include <apsis/run/simulation.hpp>

namespace apsis {

/// Time steps of a steady run whose iteration failed. The next attempt starts from their final state. Method
/// and limiter are those of a case without [time]. Members are collective.
class interim_march {
 public:
  /// `start` is the initial state. Throws input_error if the case cannot run in time or
  /// memory does not suffice.
  interim_march(const run_setup& setup, const field& start, double duration);

  /// Advances by a twentieth of the duration; u ← the state. Throws numerical_error as
  /// simulation::advance() does.
  void advance(field& u);
  bool finished() const { return run_.finished(); }  ///< whether the duration is over
  double t() const { return run_.t(); }              ///< time since the beginning

 private:
  double part_;  ///< a twentieth of the duration
  simulation run_;
};

}  // namespace apsis
