#pragma once

#include <apsis/integrate/equal_steps.hpp>
#include <apsis/integrate/error_control.hpp>
#include <apsis/integrate/integrate.hpp>
#include <apsis/steady/negative_values.hpp>

#include <array>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace apsis {

/// A cell whose state violates the condition of its model (model::condition()).
struct condition_violation {
  long cell = -1;       ///< number of the first such cell
  double value = 0.0;   ///< first component of its row
  std::string problem;  ///< message of model::check_supported()
};

/// The results of the checks after a step; one row of history.csv. Dimensionless.
struct step_record {
  long step = 0;             ///< number of the step, 0 for the initial state
  double t = 0.0,            ///< time at the end of the step
      dt = 0.0;              ///< length of the step
  double min_value = 0.0;    ///< smallest unknown of the state
  long negative_values = 0;  ///< number of unknowns < 0
  /// |I − I₀ − received| for each invariant, relative to the largest of three amounts: its scale at the
  /// start, its scale in the state, and the amount that crossed the faces.
  std::vector<double> conservation_defect;
  double entropy = 0.0;  ///< NaN if the model has none, or if an unknown is < 0
  /// S^{n+1} − S^n minus the bound of the entropy that walls give, boundary::entropy_bound(). NaN without
  /// entropy, and at the start.
  double entropy_change = 0.0;
  /// ‖u^{n+1} − u^n‖₂/(Δt ‖u^{n+1}‖₂), the relative change per unit of time; NaN at the start, and without
  /// time.steady.
  double change = std::numeric_limits<double>::quiet_NaN();
  /// The largest relative change of the rate at which model::cut_moment() relaxes, over cells and stages of
  /// the step; empty if the model has no such moment.
  std::vector<double> cut;
  /// steady_iteration::residual of an iteration to a steady state; empty in a run in time. In such an
  /// iteration, `change` is that of the iteration. The defects of conservation are the net rates at which the
  /// gas receives the invariants.
  std::vector<double> residual;
  std::vector<double> total;  ///< I, the sum of the densities of each invariant over the domain
  /// Amounts of the invariants that the gas received through each face since the start, [face][invariant];
  /// per area on a line, per length in the plane.
  std::vector<double> received;
  std::vector<double> flux;  ///< `received` per unit of time, averaged over the step
  /// Amounts per unit of time that a force did not give, averaged over the step: ∫(ρa − given) for the
  /// components of the momentum, ∫(ρu·a − given) for the energy. Empty without force.
  std::vector<double> lost;
  std::vector<double> torque;            ///< body_load::torque of each of loaded_bodies()
  std::vector<double> wall_temperature;  ///< mean of each of found_walls() after the step
  /// |I − I₀ − received| of this step alone, relative to the larger of the scales at the start and of the
  /// state. visit_members() omits this and the following members, so they are not saved.
  std::vector<double> defect_of_step = {};
  std::optional<condition_violation> violation = {};  ///< not saved
  /// |lost momentum|/∫ρ|a|, and |lost energy|/(c ∫ρ|a|) with the speed c = √(2E/M) of mass M and
  /// energy E; not saved.
  std::array<double, 2> lost_share = {};
  removed_values removed = {};  ///< steady_iteration::removed; not saved
  /// Σ_cells |ρ^n − ρ^{n−1}| of the last invariant, relative to its scale; not saved.
  double density_change = 0.0;
  /// Σ_cells |ρ^n − 2ρ^{n−1} + ρ^{n−2}| of the same invariant, relative to the same scale; not saved.
  double density_turn = 0.0;

  /// Calls visit(name, member) for every member of `self`, in the order of the columns of the history.
  template <class Self, class Visitor>
  static void visit_members(Self& self, Visitor&& visit) {
    visit("step", self.step);
    visit("t", self.t);
    visit("dt", self.dt);
    visit("min_value", self.min_value);
    visit("negative_values", self.negative_values);
    visit("conservation", self.conservation_defect);
    visit("entropy", self.entropy);
    visit("entropy_change", self.entropy_change);
    visit("change", self.change);
    visit("cut", self.cut);
    visit("residual", self.residual);
    visit("total", self.total);
    visit("received", self.received);
    visit("flux", self.flux);
    visit("lost", self.lost);
    visit("torque", self.torque);
    visit("T_w", self.wall_temperature);
  }
};

/// Totals of a run, finished or not.
struct run_summary {
  long steps = 0;                     ///< steps taken
  long startup_steps = 0;             ///< steps that replaced the first one; 0 without graded start-up
  long rejected_steps = 0;            ///< steps with too large an estimated error; not counted in `steps`
  double dt = 0.0,                    ///< longest step
      t = 0.0,                        ///< time reached
      wall_s = 0.0;                   ///< wall time of the steps in seconds, including those before a restart
  double min_value = 0.0;             ///< smallest unknown of all steps, including the initial state
  long negative_values = 0;           ///< number of unknowns < 0, summed over all steps
  double conservation_defect = 0.0;   ///< largest of any invariant and step
  double max_entropy_increase = 0.0;  ///< largest entropy_change; 0 if none was positive
  double largest_cut = 0.0;           ///< largest step_record::cut
  long phase_points = 0;              ///< cells × components
  double point_stages_per_s = 0.0;    ///< phase_points · stages per second of wall time, with rejected steps
  /// For a gas, smallest distance from a bulk velocity to an end of the velocities, in thermal speeds √T. The
  /// minimum is over all cells and steps that velocity_watch examines.
  double velocity_room = std::numeric_limits<double>::infinity();
  double velocity_resolution =
      std::numeric_limits<double>::infinity();  ///< smallest ratio of thermal speed and spacing
  double velocity_beyond = 0.0,                 ///< largest share of the mass of a Maxwellian beyond the ends
      velocity_missed = 0.0,                    ///< largest velocity_fit::missed; 0 if every cell was safe
      velocity_needed = 0.0;   ///< largest velocity that would suffice; 0 if the room is enough
  double velocity_held = 0.0;  ///< mass that a force moved into the last velocities, relative to the mass
  double force_lost_momentum = 0.0,  ///< largest step_record::lost_share
      force_lost_energy = 0.0;       ///< largest share of the energy
  double cpu_s = 0.0;  ///< CPU time of the calling thread in steps since the start or the last restart

  /// Calls visit(name, member) for every member of `self` that belongs to the result, in the order of the
  /// manifest. cpu_s is a property of the process.
  template <class Self, class Visitor>
  static void visit_members(Self& self, Visitor&& visit) {
    visit("steps", self.steps);
    visit("startup_steps", self.startup_steps);
    visit("rejected_steps", self.rejected_steps);
    visit("dt", self.dt);
    visit("t", self.t);
    visit("wall_s", self.wall_s);
    visit("min_value", self.min_value);
    visit("negative_values", self.negative_values);
    visit("conservation_defect", self.conservation_defect);
    visit("max_entropy_increase", self.max_entropy_increase);
    visit("largest_cut", self.largest_cut);
    visit("phase_points", self.phase_points);
    visit("point_stages_per_s", self.point_stages_per_s);
    visit("velocity_room", self.velocity_room);
    visit("velocity_resolution", self.velocity_resolution);
    visit("velocity_beyond", self.velocity_beyond);
    visit("velocity_missed", self.velocity_missed);
    visit("velocity_needed", self.velocity_needed);
    visit("velocity_held", self.velocity_held);
    visit("force_lost_momentum", self.force_lost_momentum);
    visit("force_lost_energy", self.force_lost_energy);
  }
};

/// A value that an integrator needs in addition to u.
struct kept_value {
  std::vector<double> unknowns,  ///< [cells][components]
      budget;                    ///< boundary_budget of the whole mesh
};

/// Group of the position in the history in a checkpoint.
inline constexpr const char* history_group = "multistep";
/// Group of the iteration to a steady state in a checkpoint.
inline constexpr const char* steady_group = "steady";

/// The iteration to a steady state between two iterations. Images of earlier iterations are not saved.
struct steady_progress {
  double reference = std::numeric_limits<double>::quiet_NaN();  ///< steady_solver::reference()

  /// Calls visit(name, member) for every member of `self`.
  template <class Self, class Visitor>
  static void visit_members(Self& self, Visitor&& visit) {
    visit("reference", self.reference);
  }
};

/// A run between two steps, as a checkpoint saves it and a restart continues it. A new number needs a member
/// of one of the records and a line in its visit_members(). It is then saved, restored and reported in the
/// manifest. A number of step_record also appears in the history.
struct run_state {
  std::vector<double> unknowns;                              ///< [cells][components]
  time_marcher<double>::progress march;                      ///< position in time
  std::optional<step_controller<double>::progress> control;  ///< step control; nothing without tolerance
  std::optional<history_position<double>> history;           ///< nothing if steps need only u
  std::optional<steady_progress> steady = {};                ///< nothing in a run in time
  run_summary totals;                                        ///< totals of all steps so far
  step_record initial,                                       ///< record of the initial state
      last;                                                  ///< record of the last step
  std::vector<double> budget = {};    ///< boundary_budget of the last step; empty before the first one
  std::vector<kept_value> kept = {};  ///< values of earlier steps

  /// Calls visit(group, record) for every record of numbers that a checkpoint stores by name. Records of
  /// steps are rows of the history.
  template <class Self, class Visitor>
  static void visit_records(Self& self, Visitor&& visit) {
    visit("march", self.march);
    if (self.control) visit("control", *self.control);
    if (self.history) visit(history_group, *self.history);
    if (self.steady) visit(steady_group, *self.steady);
    visit("totals", self.totals);
  }
};

}  // namespace apsis
