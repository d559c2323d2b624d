#pragma once

#include <apsis/device/row_checks.hpp>
#include <apsis/exec/parallel.hpp>
#include <apsis/mesh/field.hpp>
#include <apsis/model/checks_of_rows.hpp>
#include <apsis/run/internal/torque_sum.hpp>
#include <apsis/run/setup.hpp>
#include <apsis/run/simulation.hpp>
#include <apsis/run/step_differences.hpp>
#include <apsis/run/velocity_watch.hpp>
#include <apsis/semidiscrete/budgeted_problem.hpp>

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

namespace apsis {

/// Checks the state after every step: smallest value, conservation, entropy. Sums are exact and rounded
/// once. Results therefore depend neither on the number of threads nor on that of processes. All
/// members are collective.
class monitor {
 public:
  /// `setup` must outlive the object.
  explicit monitor(const run_setup& setup);
  ~monitor();

  /// Sets the reference state of conservation and returns its record. Defects are relative to Σ_cells volume
  /// · model::invariant_scales().
  step_record start(const field& u);

  /// Returns the record of the state after a step of length dt, without step and t. `after` has the budget of
  /// this step; `cut` is its semidiscrete_problem::take_cut(). Throws numerical_error at the first number
  /// that is not finite.
  step_record check(const budgeted_state& after, double dt, const step_record& previous, double cut = 0.0);

  /// Enters the findings of the last start() or check() about the velocities of a gas into `summary`. `u` is
  /// the state that was checked. velocity_watch::update() describes warnings and errors.
  void watch_velocities(const field& u, const step_record& last, run_summary& summary);

  /// Discards differences from earlier steps, which do not precede a restart.
  void forget_steps() { differences_.restart(); }

 private:
  struct totals {
    std::vector<double> invariants, scales;
    double entropy = 0.0, lowest = 0.0;
    double change = 0.0, turn = 0.0;  ///< step_record::density_change, density_turn
    long negative = 0;
    bool violated = false;  ///< whether some cell violates the condition of the model
    int violating = -1;     ///< first such cell of this process
    velocity_extremes velocities;
    velocity_margins margins;  ///< smallest of all processes
  };
  struct partial;
  device_row_checks::row look_at(const field& u, int cell, double* densities) const;
  double entropy_of(double entropy, int cell, double density) const;
  void check_cells(const field& u, int begin, int end, partial& own) const;
  void find_scales(int cells, partial& own) const;
  int cells_with_condition(const field& u, int begin, int end) const;
  bool check_row(const field& u, int cell, double* densities, partial& own) const;
  void add_densities(int cell, std::span<const double> densities, const double* scales, partial& own) const;
  const field& checkable(const field& u, field& room) const;
  partial check_block(const field& u) const;
  totals sum(const field& u) const;
  std::optional<condition_violation> violation_in(const field& u, const totals& t) const;
  std::vector<double> received_through_faces(const std::vector<double>& amounts) const;
  void take_losses(std::vector<double>& received, double dt, const totals& t, step_record& record);
  void keep_velocities(const totals& t);
  void compare(const totals& t, const std::vector<double>& before, const std::vector<double>& received,
               step_record& record) const;

  const run_setup& setup_;
  const model& equation_;
  const checks_of_rows* of_rows_;                 ///< null if the model has no such checks
  std::unique_ptr<device_row_checks> on_device_;  ///< null if rows are checked on the host
  std::optional<convex_entropy> entropy_;
  double volume_;                       ///< of a cell; 1 for an ordinary differential equation
  std::vector<std::size_t> ends_;       ///< number of ends at each face
  std::vector<double> entropy_bounds_;  ///< bounds of entropy per received amount, [face][invariant]
  torque_sum torques_;
  std::unique_ptr<per_thread<partial>> parts_;
  mutable step_differences differences_;     ///< differences of the last invariant
  std::vector<double> invariants_, scales_;  ///< of the initial state
  velocity_watch velocities_;
  velocity_extremes extremes_;  ///< extremes of the last state
  velocity_margins margins_;    ///< smallest of all processes
  std::vector<double> losses_;  ///< force_losses of the last step; empty without force
};

}  // namespace apsis
