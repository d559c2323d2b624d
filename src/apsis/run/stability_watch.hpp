#pragma once

#include <apsis/core/errors.hpp>
#include <apsis/run/run_state.hpp>
#include <apsis/run/setup.hpp>

#include <string>

namespace apsis {

/// Returns the CFL number of a step, Δt max_j Σ_k |v_jk|/Δx_k; 0 without velocities. time.cfl takes the
/// largest speed of each direction instead, which no single velocity may have.
double cfl_number(const run_setup& setup, double dt);

/// Reports the CFL number to which time.safety is relative where that is below r, and warns if steps of
/// length dt exceed the linear stability limit of the method with the reconstruction.
void warn_of_unstable_steps(const run_setup& setup, double dt);

/// Returns the end of a message on an unstable run, "(CFL number …); use …": a step within the limit, or, if
/// steps of length dt are within it, a smaller step and a more robust reconstruction. Requires space.
std::string remedy_of_instability(const run_setup& setup, double dt);

/// Returns the failure of a step dt; if that exceeds the linear stability limit, the message names this
/// cause.
numerical_error naming_instability(const numerical_error& failure, const run_setup& setup, double dt);

/// Notices an instability while a case runs, from the changes of a density in the last three steps,
/// step_record::density_change and density_turn. Resolved waves turn slowly: the second difference is a
/// fraction of the first. Unstable waves have some cells and turn by more than a radian in every step. Eight
/// steps alternate if second differences exceed first ones, and rounding. The solution is unstable if
///   (1) they are 100 times those of the calmest eight steps so far, or
///   (2) 128 steps alternate beyond the linear stability limit: the weights of WENO bound the growth.
/// A short wave in free flight alternates too, but does not grow, and (2) is not asked within the limit.
/// Steps of changing length are not judged, nor those of time.tolerance, which rejects them.
class stability_watch {
 public:
  /// `setup` must outlive the object.
  explicit stability_watch(const run_setup& setup) : setup_(setup) {}

  /// Judges a step. Warns once, with the step that would be stable. Throws numerical_error, without step and
  /// time, when the solution is unstable and a hundredth of a density alternates.
  void add(const step_record& step);

 private:
  static constexpr int judged = 8;
  void judge();
  void begin_again();

  const run_setup& setup_;
  int steps_ = 0,     ///< of the current eight
      in_a_row_ = 0;  ///< eights that alternate
  double change_ = 0.0, turn_ = 0.0, dt_ = 0.0, calmest_ = -1.0;
  bool unstable_ = false;
};

}  // namespace apsis
