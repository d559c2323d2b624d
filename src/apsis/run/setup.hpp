#pragma once

#include <apsis/config/case.hpp>
#include <apsis/method/method.hpp>
#include <apsis/model/model_registry.hpp>
#include <apsis/run/simulation.hpp>
#include <apsis/semidiscrete/problem_builder.hpp>

#include <memory>
#include <optional>
#include <vector>

namespace apsis {

/// Everything that a case names, made and checked against each other before the first step: names and numbers
/// of the case become calls of a problem_builder.
class run_setup {
 public:
  /// Throws input_error: mesh smaller than the stencil, method that cannot integrate the model, epsilon(x)
  /// not a finite number ≥ 0 on the mesh.
  explicit run_setup(const case_config& config);

  std::unique_ptr<model> equation;  ///< model.name with its parameters and velocity grid

  /// The case.
  const case_config& config() const { return config_; }
  /// time.method, of the catalogue or from a file.
  const method& integrator() const { return *method_; }
  /// r of Δt ≤ r Δt_FE; 0 if the method has none.
  double ssp_coefficient() const { return ssp_coefficient_; }

  /// T and Q on the mesh of the case. Refers to the model of this setup, which must outlive it.
  std::unique_ptr<semidiscrete_problem> make_problem() const;
  /// Cell averages (finite volume) or point values (finite difference) of the named initial data. Throws
  /// input_error where the velocity grid cannot hold them.
  field initial_state() const;
  /// The exact solution at time t in the same form; nothing where no formula is known for the data.
  std::optional<field> exact_state(double t) const;
  /// Whether exact_state() knows a formula.
  bool has_exact_state() const { return static_cast<bool>(data().exact); }

  /// Whether the model has a mesh; without one there is a single cell.
  bool has_space() const { return builder_.has_space(); }
  /// Δx, or 1 without space.
  double cell_volume() const { return has_space() ? builder_.mesh().cell_volume() : 1.0; }
  /// x of the cell centres; {0} without space.
  std::vector<double> centres() const;
  /// ε(x) at the cell centres.
  std::vector<double> epsilon_at_centres() const { return builder_.epsilon_at_centres(); }
  /// dt if it was given as a number and every step is that long.
  std::optional<double> given_dt() const { return has_tolerance() ? std::nullopt : config_.time.dt; }
  /// Whether the steps keep time.tolerance.
  bool has_tolerance() const { return config_.time.tolerance.has_value(); }
  /// Δx/v_max, so that Δt = cfl · this.
  double cfl_length() const;
  /// Whether the first step is cut into steps that resolve the initial layer (time.startup).
  bool has_graded_start() const { return config_.time.startup == startup_choice::graded; }

  /// Largest defect of an invariant, Σ|ℛE(ℛu) − ℛu| over all cells relative to its scale; 0 for models that
  /// do not relax to an equilibrium.
  double equilibrium_defect(const field& u) const;
  /// What a run with steps of dt ≤ r Δt_FE = `limit` promises; `nonnegative`: the initial state is;
  /// `exact_equilibrium`: E has the moments of u up to rounding.
  void decide_promises(run_promises& promises, double dt, double limit, bool nonnegative,
                       bool exact_equilibrium) const;

 private:
  const initial_data& data() const;
  void build_space();
  void set_epsilon();
  void check_method();
  void check_startup() const;
  void check_tolerance() const;

  case_config config_;
  problem_builder builder_;
  const method* method_ = nullptr;
  double ssp_coefficient_ = 0.0;
};

}  // namespace apsis
