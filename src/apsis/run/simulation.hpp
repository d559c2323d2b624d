#pragma once

#include <apsis/config/case.hpp>
#include <apsis/exec/communicator.hpp>
#include <apsis/mesh/field.hpp>
#include <apsis/mesh/grid.hpp>
#include <apsis/run/field_table.hpp>
#include <apsis/run/run_promises.hpp>
#include <apsis/run/run_state.hpp>
#include <apsis/run/surface_table.hpp>

#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace apsis {

class run_setup;

/// Function that returns the state from which a run starts, in place of the initial data of its case.
using state_source = std::function<field(const run_setup& setup)>;

/// One run of a case. The constructor checks everything that can be checked before the first step. In a
/// case with a table [steady], steps are iterations to the steady state, and t counts them. Nothing is
/// promised for iterates.
class simulation {
 public:
  /// Throws input_error (for example: v_max too small for the data, mesh smaller than the stencil).
  /// `start` returns the initial state, if it is not that of the case.
  /// `processes` share the mesh. Every member function that computes or returns values of cells is
  /// then collective. Values of all cells, such as fields, are on the root only; states have the
  /// cells of this process.
  explicit simulation(const case_config& config, const state_source& start = {},
                      const std::shared_ptr<communicator>& processes = single_process());
  /// Runs a case that has been set up, and whose memory has been checked.
  explicit simulation(std::unique_ptr<run_setup> setup, const state_source& start = {});
  ~simulation();
  simulation(simulation&&) noexcept;             ///< leaves the source empty
  simulation& operator=(simulation&&) noexcept;  ///< leaves the source empty

  const case_config& config() const;     ///< the case as given
  const run_setup& setup() const;        ///< the objects of the case: its model, mesh and faces
  const run_promises& promises() const;  ///< promises checked after every step
  double t() const;                      ///< time reached
  double dt() const;                     ///< length of the next step
  long step() const;                     ///< steps taken
  long steps_total() const;              ///< estimate of the total number of steps
  bool finished() const;                 ///< whether t() is time.end, or a steady state is reached
  /// Returns the forecast of the relative error from terms of size ε in a run with time.tolerance. The run
  /// warns if it exceeds the tolerance. Returns 0 if the steps resolve the relaxation, or without tolerance.
  double expected_plateau() const;
  /// Returns the estimate of the relative error at time.end from terms of size ε in the steps of the method
  /// (loss_watch). The run warns if it is large. Returns 0 without such an error, or without an estimate.
  double expected_loss() const;
  /// Returns the share of r Δt_FE for which the positivity limiter is set
  /// (transport::limit_for_steps); 1 if steps vary.
  double limiter_share() const;
  /// Returns the number of snapshot times k · output.every, k ≥ 1, up to t(). Steps end
  /// exactly at each of them.
  long snapshot_times_passed() const;
  /// Returns whether the next step depends on time.end. A checkpoint for a continuation to a later end must
  /// be taken before this step.
  bool next_step_depends_on_end() const;

  /// Takes one step. Throws numerical_error with step, time, cell and value. If a stage failed, the state
  /// is that of the last good step. If a promise was broken, the state is the one that broke it, and
  /// last() describes it.
  const step_record& advance();
  /// Returns whether the run may continue from its state after advance() has thrown, because all iterations
  /// to a steady state were used.
  bool may_continue() const;
  const step_record& last() const;  ///< record of the last step, or of the initial state
  run_summary summary() const;      ///< totals of all steps so far

  field_table fields() const;  ///< macroscopic fields of the current state
  /// Returns the amounts that the gas gave to the surfaces of output.surfaces in the last step
  /// (compute_surfaces()). Empty on other processes than the root.
  std::vector<surface_table> surfaces() const;
  const grid& mesh() const;         ///< the mesh; a single cell without space
  communicator& processes() const;  ///< the processes that share the mesh
  /// Returns the unknowns (f in axisymmetric flow), [cells of setup().mesh()][components], contiguous.
  std::vector<double> state() const;
  /// Returns the unknowns of a cell of setup().mesh() (r f in axisymmetric flow). They are valid
  /// until the next step.
  std::span<const double> row(int cell) const;
  /// Returns the row of a cell in state().
  std::vector<double> densities_in(int cell) const;
  /// Returns the state of the whole mesh on the root, [cells][components]; elsewhere it is empty. Collective.
  std::vector<double> whole_state() const;
  /// Returns the exact solution at t() in the form of state(); empty if no formula is known.
  std::vector<double> exact_state() const;
  std::vector<double> epsilon() const;  ///< ε at the cell centres

  /// Returns the state for a bitwise identical restart.
  run_state save() const;
  /// Continues from a saved state of the same case. Throws input_error if the sizes differ. If `saved` has no
  /// budget, values at surfaces are NaN until the next step.
  void restore(const run_state& saved);
  const step_record& initial_record() const;  ///< record of the initial state

 private:
  struct impl;
  std::unique_ptr<impl> impl_;
};

}  // namespace apsis
