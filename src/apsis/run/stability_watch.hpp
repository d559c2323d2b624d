#pragma once

#include <apsis/core/errors.hpp>
#include <apsis/run/run_state.hpp>
#include <apsis/run/setup.hpp>

#include <string>

namespace apsis {

/// Returns the CFL number of a step, Δt max_j Σ_k |v_jk|/Δx_k; 0 without velocities. time.cfl instead uses
/// the largest speed of each direction. A velocity with all of these speeds need not exist.
double cfl_number(const run_setup& setup, double dt);

/// Logs the CFL number to which time.safety is relative, if that is below r. Warns if steps of length dt
/// exceed the linear stability limit of the method with the reconstruction.
void warn_of_unstable_steps(const run_setup& setup, double dt);

/// Returns the end of a message on an unstable run, "(CFL number …); use …". If steps of length dt exceed the
/// limit, it suggests a step within the limit. Otherwise it suggests a smaller step and a more robust
/// reconstruction. Requires space.
std::string remedy_of_instability(const run_setup& setup, double dt);

/// Returns the failure of a step dt. If dt exceeds the linear stability limit, the message names this cause.
numerical_error naming_instability(const numerical_error& failure, const run_setup& setup, double dt);

/// Detects an instability while a case runs, from the changes of a density in the last three steps
/// (step_record::density_change and density_turn). Resolved waves turn slowly: the second difference is a
/// fraction of the first. Unstable waves are some cells long and turn by more than a radian in every step.
/// Steps are judged in groups of eight. A group alternates if its second differences exceed both the first
/// differences and rounding. The solution is unstable if a group alternates and one of two conditions holds:
///   (1) Its second differences are 100 times those of the calmest group so far.
///   (2) 128 steps in a row alternate beyond the linear stability limit: the weights of
///   WENO bound the growth.
/// A short wave in free flight alternates too, but does not grow; (2) therefore does not apply within the
/// limit. Steps of changing length are not judged, nor those of time.tolerance, which rejects unstable steps.
class stability_watch {
 public:
  /// `setup` must outlive the object.
  explicit stability_watch(const run_setup& setup) : setup_(setup) {}

  /// Judges a step. Warns once, with a step that would be stable. Throws numerical_error, without step and
  /// time, when the solution is unstable and a hundredth of a density alternates.
  void add(const step_record& step);

 private:
  static constexpr int judged = 8;
  void judge();
  void begin_again();

  const run_setup& setup_;
  int steps_ = 0,     ///< steps in the current group
      in_a_row_ = 0;  ///< successive groups that alternate
  double change_ = 0.0, turn_ = 0.0, dt_ = 0.0, calmest_ = -1.0;
  bool unstable_ = false;
};

}  // namespace apsis
