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

/// Returns the state from which a run starts in place of the initial data of its case.
using state_source = std::function<field(const run_setup& setup)>;

/// One run of a case. The constructor checks everything that can be checked before the first step. In a case
/// with a table [steady], steps are iterations to the steady state, t counts them, and nothing is promised.
class simulation {
 public:
  /// Throws input_error (for example: v_max too small for the data, mesh smaller than the stencil).
  /// `start`: the initial state, if it is not that of the case.
  /// `processes` share the mesh: every member function that computes or returns values of cells is then
  /// collective, and fields and exact states of all cells are on the root only.
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
  bool finished() const;  ///< whether t() is time.end, or the state is steady, or the steady state is found
  /// Returns the forecast of the relative error from terms of size ε in a run with time.tolerance; a warning
  /// is given if it exceeds the tolerance. 0 if the steps resolve the relaxation, or without tolerance.
  double expected_plateau() const;
  /// Returns the estimate of the relative error at time.end from terms of size ε that the method loses in its
  /// steps (loss_watch); a warning is given where it matters. 0 if nothing is lost or nothing is known.
  double expected_loss() const;
  /// Returns the share of r Δt_FE that the positivity limiter is for (transport::limit_for_steps); 1 if steps
  /// vary.
  double limiter_share() const;
  /// Returns the number of snapshot times k · output.every, k ≥ 1, up to t(); steps end at each of them
  /// exactly.
  long snapshot_times_passed() const;
  /// Whether the next step depends on time.end; a checkpoint for a continuation to a later end is taken
  /// before it.
  bool next_step_depends_on_end() const;

  /// Takes one step. Throws numerical_error with step, time, cell and value. If a stage failed, the state is
  /// that of the last good step; if a promise was broken, it is the state that broke it, and last() describes
  /// it.
  const step_record& advance();
  /// Whether the run may continue from its state after advance() has thrown: all iterations to a steady state
  /// were used.
  bool may_continue() const;
  const step_record& last() const;  ///< record of the last step, or of the initial state
  run_summary summary() const;      ///< totals of all steps so far

  field_table fields() const;  ///< macroscopic fields of the current state
  /// Returns what the gas gave in the last step to the surfaces of output.surfaces (compute_surfaces()); on
  /// the root.
  std::vector<surface_table> surfaces() const;
  const grid& mesh() const;         ///< the mesh; a single cell without space
  communicator& processes() const;  ///< the processes that share the mesh
  /// Returns the unknowns, of axisymmetric flow f: [cells of setup().mesh()][components], contiguous.
  std::vector<double> state() const;
  /// Returns the unknowns of a cell of setup().mesh(), of axisymmetric flow r f, valid until the next step.
  std::span<const double> row(int cell) const;
  /// Returns the row of a cell in state().
  std::vector<double> densities_in(int cell) const;
  /// Returns the state of the whole mesh, [cells][components]; on the root, elsewhere nothing. Collective.
  std::vector<double> whole_state() const;
  /// Returns the exact solution at t() in the form of state(); empty if no formula is known.
  std::vector<double> exact_state() const;
  std::vector<double> epsilon() const;  ///< ε at the cell centres

  /// Returns the state for a restart that is bitwise identical.
  run_state save() const;
  /// Continues from where `saved` was taken; the case must be the same. Throws input_error if the sizes
  /// differ. Surfaces are NaN until the next step where `saved` has no budget.
  void restore(const run_state& saved);
  const step_record& initial_record() const;  ///< record of the initial state

 private:
  struct impl;
  std::unique_ptr<impl> impl_;
};

}  // namespace apsis
