#pragma once

#include <apsis/mesh/field.hpp>
#include <apsis/run/interim_march.hpp>
#include <apsis/run/progression.hpp>
#include <apsis/steady/continuation.hpp>
#include <apsis/steady/steady_solver.hpp>

#include <cstddef>
#include <memory>
#include <optional>

namespace apsis {

/// Iterations of a steady_solver in place of steps; t counts them. Fluxes are those of the last residual. The
/// amounts received since the start are 0, and defects of conservation are the net rates. The only promise is
/// the sign of the steady state (is_nonnegative()).
///
/// If an iteration fails because f has no equilibrium, or because it diverges, it begins again from the first
/// state with a stronger pseudo-time term. If that fails too, or if the residual stalls, each continuation
/// gives a start, once. If an iteration fails after that, the run marches in time from its first state, and
/// then iterates again. Iterations of a continuation count as others do; a part of the march counts as one.
class steady_iterations final : public progression {
 public:
  /// `run` must outlive the object.
  explicit steady_iterations(running_case& run) : run_(run) {}

  void start() override;
  void advance() override;
  /// Throws numerical_error if steady.iterations were not enough.
  void check() override;
  bool watches_velocities() const override { return true; }
  bool finished() const override { return found_; }
  double next_dt() override { return run_.march.next(1.0); }
  long steps_left() override { return run_.march.steps_left(1.0); }
  bool next_step_depends_on_end() override { return false; }
  std::size_t stages_of_step() const override { return 1; }
  void save(run_state& saved) const override;
  void restore(const run_state& saved) override;

 private:
  void make_solver();
  steady_iteration iterate();
  steady_iteration recover(const numerical_error& failure);
  steady_iteration replace(const numerical_error& failure);
  bool begin_again(const numerical_error& failure);
  bool begin_continuation(const numerical_error& failure, std::size_t allowed = continuations);
  steady_iteration follow_continuation();
  void begin_march(const numerical_error& failure);
  steady_iteration march();
  steady_iteration end_of_detour(bool finished);
  void log_damping(int damping);
  static void log_removed(const steady_iteration& done);
  void record(const steady_iteration& done);
  void set_net_rates();

  running_case& run_;
  std::optional<steady_solver> solver_;
  std::unique_ptr<continuation> easier_;  ///< easier problems, between two attempts
  std::optional<interim_march> march_;    ///< steps in time, between two attempts
  field first_;                           ///< state before the first iteration
  std::size_t tried_ = 0;                 ///< number of continuations tried
  int marches_ = 0;                       ///< number of marches begun
  int damping_ = 0;                       ///< damping of the last iteration
  bool found_ = false;                    ///< whether the steady state is found
};

}  // namespace apsis
