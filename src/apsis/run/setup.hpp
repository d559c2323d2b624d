#pragma once

#include <apsis/config/case.hpp>
#include <apsis/core/construction_count.hpp>
#include <apsis/device/device.hpp>
#include <apsis/method/time_integrator.hpp>
#include <apsis/model/model_registry.hpp>
#include <apsis/model/velocity_support.hpp>
#include <apsis/run/run_promises.hpp>
#include <apsis/semidiscrete/problem_builder.hpp>

#include <limits>
#include <memory>
#include <optional>
#include <vector>

namespace apsis {

/// The objects of a case, built and checked before the first step. Translates the names and numbers of the
/// case into calls of a problem_builder.
class run_setup : public construction_count<run_setup> {
 public:
  /// `processes` share the mesh; states and fields are those of the block of this process. The problem and
  /// its states live on the device `on`, with the same bits as on the host; null selects the host.
  ///
  /// Throws input_error if the mesh is smaller than the stencil, or the method cannot integrate the model.
  /// Also throws it if epsilon(x) is not a finite number ≥ 0 on the mesh, or a part of the case has no
  /// kernel for the device.
  explicit run_setup(const case_config& config, std::shared_ptr<communicator> processes = single_process(),
                     std::shared_ptr<device> on = nullptr);

  std::shared_ptr<const model> equation;  ///< model.name with its parameters and velocity grid

  /// Returns the case.
  const case_config& config() const { return config_; }
  /// Returns time.method.
  const time_integrator& integrator() const { return *integrator_; }
  /// Returns the name of time.method.
  const std::string& integrator_name() const { return integrator_->name; }
  /// Returns the number of stages of a step.
  std::size_t stages() const { return integrator_->stages; }
  /// Returns the number of stages that a step computes, including those for its estimated error.
  std::size_t stages_of_step() const;
  /// Returns the SSP coefficient r; 0 if the method has none.
  double ssp_coefficient() const { return integrator_->ssp_coefficient; }
  /// Returns the linear stability limit of time.method with space.reconstruction, as a CFL number;
  /// infinite without space.
  double stability_limit() const { return stability_limit_; }
  /// Returns the longest step in units of Δt_FE, to which time.safety is relative. It is the smaller of r and
  /// stability_limit()/κ with κ = problem_builder::cfl_number(). If the method has no r, it is
  /// stability_limit()/κ; without space, it is r.
  double step_coefficient() const;

  /// Returns the semi-discrete problem of the case. This setup must outlive it, because the problem
  /// refers to its model.
  std::unique_ptr<semidiscrete_problem> make_problem() const;
  /// Returns the problem with implicit stage solves, for any method.
  std::unique_ptr<semidiscrete_problem> make_implicit_problem() const;
  /// Returns cell averages (finite volume) or point values (finite difference) of the initial data. Throws
  /// input_error if the velocity grid does not support them.
  field initial_state() const;
  /// Returns a state given in place of the initial data of the case. Throws input_error if the model or the
  /// velocity grid does not support it. If the state was `computed` on a velocity grid, a warning replaces
  /// the error about that grid.
  field checked(field u, bool computed = false) const;
  /// Returns the memory of the states of a run.
  const memory_space& memory() const;
  /// Returns the device; null for the host.
  device* runs_on() const { return device_.get(); }
  /// Returns the builder of the problem, which samples functions of position on the mesh.
  const problem_builder& builder() const { return builder_; }
  /// Returns the exact solution at time t in the form of initial_state(); nothing if no formula is known.
  std::optional<field> exact_state(double t) const;
  /// Returns whether the exact solution is known.
  bool has_exact_state() const { return static_cast<bool>(data().exact); }

  /// Returns whether the model has space; without it there is a single cell.
  bool has_space() const { return builder_.has_space(); }
  /// Returns the cell volume, or 1 without space. In axisymmetric flow, where unknowns are r f, it is the
  /// volume of the ring divided by r.
  double cell_volume() const { return has_space() ? mesh().measure() * mesh().cell_volume() : 1.0; }
  /// Returns the densities f of a state. In axisymmetric flow, where unknowns are r f, they are stored in
  /// `room`; otherwise they are the state.
  const field& densities(const field& u, field& room) const;
  /// Returns the mesh, or the block of this process; a single cell without space.
  const grid& mesh() const { return builder_.mesh(); }
  /// Returns the mesh of all processes.
  const grid& whole_mesh() const { return builder_.whole_mesh(); }
  /// Returns the processes that share the mesh.
  communicator& processes() const { return builder_.processes(); }
  /// Returns the number that a cell of this process has in the whole mesh.
  long number_in_whole_mesh(int cell) const { return whole_mesh().cell_of(mesh(), cell); }
  /// Returns whether both ends along a direction are periodic.
  bool periodic(int direction) const { return builder_.space().periodic(direction); }
  /// Returns the names of the surfaces with a budget: faces that are not periodic, such as "left",
  /// solid boxes and bodies. The `balance_terms` that the case has follow.
  std::vector<std::string> open_faces() const;
  /// Returns the number of ends of segments at each of open_faces(), the layout of a boundary_budget. It is 1
  /// for the force, the rotation and the source.
  std::vector<std::size_t> open_ends() const;
  /// Returns boundary::entropy_bound() of open_faces(), [face][invariant]. Returns nothing if there is no
  /// bound of the entropy that one of them gives.
  std::optional<std::vector<double>> entropy_bounds() const;
  /// Returns ε at the cell centres.
  std::vector<double> epsilon_at_centres() const { return builder_.epsilon_at_centres(); }
  /// Returns time.dt if every step has this length.
  std::optional<double> given_dt() const { return has_tolerance() ? std::nullopt : config_.time.dt; }
  /// Returns whether time.tolerance controls the step size.
  bool has_tolerance() const { return config_.time.tolerance.has_value(); }
  /// Returns 1/Σ_k (v_max,k/Δx_k). Δt is the CFL number times this.
  double cfl_length() const;
  /// Returns whether the first step is divided to resolve the initial layer (time.startup).
  bool has_graded_start() const { return config_.time.startup == startup_choice::graded; }

  /// Returns the largest defect of an invariant in equilibria, Σ|ℛE(ℛu) − ℛu| over all cells relative to its
  /// scale; 0 for models that do not relax to an equilibrium.
  double equilibrium_defect(const field& u) const;
  /// Decides the promises of a run with steps dt. `limit` is r Δt_FE. `nonnegative`: the initial state is
  /// nonnegative. `exact_equilibrium`: E has the moments of u up to rounding.
  void decide_promises(run_promises& promises, double dt, double limit, bool nonnegative,
                       bool exact_equilibrium) const;

 private:
  std::string solid_name(int solid) const;
  const initial_data& data() const;
  void check_cells(const field& u, bool computed) const;
  void warn_of_velocities(const velocity_support& support, double missed, int cell,
                          const std::vector<double>& omega) const;
  void build_space(std::shared_ptr<communicator> processes);
  void move_to_device();
  void set_epsilon();
  void set_prescribed_data();
  void check_method();
  void set_stability_limit();
  void check_startup() const;
  void check_tolerance() const;

  case_config config_;
  std::shared_ptr<device> device_;  ///< null: the host
  problem_builder builder_;
  initial_data prescribed_;  ///< data of the table [initial]
  const time_integrator* integrator_ = nullptr;
  double stability_limit_ = std::numeric_limits<double>::infinity();
};

}  // namespace apsis
