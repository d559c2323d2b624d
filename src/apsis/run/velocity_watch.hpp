#pragma once

#include <apsis/mesh/field.hpp>
#include <apsis/model/velocity_support.hpp>
#include <apsis/run/run_state.hpp>
#include <apsis/run/setup.hpp>

#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace apsis {

/// The cells of this process whose Maxwellians the velocities represent worst.
struct velocity_extremes {
  static constexpr int none =  ///< stands for no cell
      std::numeric_limits<int>::max();

  /// The smallest margins.
  velocity_margins margins = {std::numeric_limits<double>::infinity(),
                              std::numeric_limits<double>::infinity()};
  int room_cell = none;        ///< where the room is smallest
  int resolution_cell = none;  ///< where the resolution is lowest

  /// Adds the extremes of other cells. Of equal cells the first counts, in any order of calls.
  void add(const velocity_extremes& other);
};

/// Watches whether the velocities of a gas represent the Maxwellian of every cell in a run
/// (docs/velocities.md). Does not watch cells with less than a thousandth of the mean density, nor cells
/// whose molecules collide fewer than 0.1 times until time.end. In these cells the Maxwellian has no effect.
/// States may live on a device; the watch copies the rows that it needs.
class velocity_watch {
 public:
  /// `setup` must outlive the object.
  explicit velocity_watch(const run_setup& setup);

  /// Returns whether the model is a gas.
  bool active() const { return support_.has_value(); }
  /// Sets the mass of the gas in the domain.
  void set_mass(double mass);
  /// Adds a cell with moments ω to `own`.
  void look(const double* omega, int cell, velocity_extremes& own) const;

  /// Enters the worst cells of all processes after a step into the totals. Warns the first time that the
  /// velocities miss more than velocity_limits::good. Throws numerical_error if more than
  /// velocity_limits::bad lies beyond the ends. `margins` are the smallest of all processes. Collective.
  void update(const velocity_extremes& mine, const velocity_margins& margins, const field& u,
              const step_record& at, run_summary& totals);
  /// Does the same for the initial state, without the warnings that the setup gives.
  void start(const velocity_extremes& mine, const velocity_margins& margins, const field& u,
             run_summary& totals);
  /// Adds a share of the mass that a force moved into the last velocities in a step. Warns when the sum
  /// exceeds one percent. Collective.
  void add_held(double share, const field& u, const step_record& at, run_summary& totals) const;
  /// Enters step_record::lost_share into the totals: the largest of all steps, or that of the last iteration
  /// to a steady state. Warns once when a share exceeds one percent; for the energy, only with fluxes above
  /// first order. Collective.
  void add_lost(const field& u, const step_record& at, run_summary& totals);

 private:
  struct candidate {
    long cell;
    fluid_state state;
    velocity_fit fit;
  };
  bool collides(int cell, const double* omega) const;
  std::vector<candidate> new_extremes(const velocity_extremes& mine, const velocity_margins& margins,
                                      const field& u, run_summary& totals) const;
  std::optional<candidate> shared(int cell, const field& u) const;
  void judge(const candidate& worst, const field& u, const step_record& at);
  double velocity_that_would_do(const field& state, const step_record& at) const;
  std::string larger_velocities(double needed) const;
  bool& warned(const velocity_fit& fit) { return fit.ends ? warned_of_ends_ : warned_of_spacing_; }

  const run_setup& setup_;
  std::optional<velocity_support> support_;
  std::vector<double> epsilon_;  ///< ε in the cells of this process
  double volume_ = 1.0;          ///< volume of the gas
  double least_density_ = 0.0;
  bool warned_of_ends_ = false, warned_of_spacing_ = false, warned_of_loss_ = false;
};

/// The cell of all processes whose Maxwellian the velocities miss most.
struct worst_velocities {
  long cell;                  ///< number in the whole mesh
  std::vector<double> omega;  ///< moments of the cell
};
/// Returns the worst cell of all processes; nothing if no process has a cell. Each process passes its own
/// worst cell: the amount that the velocities miss, the number of the cell in the whole mesh (negative
/// without one), and its moments. Collective.
std::optional<worst_velocities> worst_of_all(communicator& processes, double missed, long number,
                                             const std::vector<double>& omega);

}  // namespace apsis
