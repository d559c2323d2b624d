#pragma once

#include <apsis/core/construction_count.hpp>
#include <apsis/core/relaxation_weights.hpp>
#include <apsis/model/data_form.hpp>
#include <apsis/model/dimension.hpp>
#include <apsis/model/point_collision.hpp>
#include <apsis/velocity/polar_layout.hpp>
#include <apsis/velocity/position.hpp>
#include <apsis/velocity/velocity_set.hpp>

#include <array>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace apsis {

/// A macroscopic field of the results.
struct field_name {
  std::string name;                 ///< "rho"
  std::string label;                ///< "density (dimensionless)"
  apsis::dimension dimension = {};  ///< its dimension in units of a gas (gas_scales.hpp)
};

/// A cell of a mesh with all that its fields depend on.
struct field_point {
  const double* u;       ///< its row
  double epsilon = 0.0;  ///< ε at its centre
  /// (∂_x φ, ∂_y φ, ∂_z φ) of the model::default_fields() φ, 0 along directions without space; empty unless
  /// the group needs them.
  std::span<const std::array<double, 3>> gradients = {};
};

/// Macroscopic fields that are computed together.
struct field_group {
  std::vector<field_name> names;  ///< at least one
  /// values ← the fields at a point, in the order of the names.
  std::function<void(const field_point& at, double* values)> compute;
  bool needs_gradients = false;  ///< whether compute() uses field_point::gradients
};

/// A convex entropy density η(u) of nonnegative rows. Its sum over all cells decays under upwind transport
/// and collision.
struct convex_entropy {
  std::function<double(const double* u)> density;  ///< η of a row ≥ 0
  bool collisions_decrease = true;  ///< whether no stage solve of a collision increases the sum
};

class gas_model;
class relaxation_model;

/// Initial data and, if a formula is known, the exact solution.
struct initial_data {
  std::string name;         ///< name in a case file (model.initial)
  std::string description;  ///< one line with the formula
  /// u ← all components at x; at a jump, those of the side of larger coordinates.
  std::function<void(const position& x, std::span<double> u)> point_value;
  /// u ← the solution at t and x, which is smooth; empty if no formula is known.
  std::function<void(double t, const position& x, std::span<double> u)> exact = {};
  std::vector<double> jumps = {};  ///< discontinuities of data on a line, in increasing order
};

/// Velocities that are all combinations of points in each of d directions, the last direction fastest.
struct velocity_lattice {
  std::vector<int> points;      ///< n_k of each direction; empty if the velocities are no lattice
  std::vector<double> spacing;  ///< Δv_k; 0 where the points are not equidistant
};

/// Data that a model cannot hold.
struct unsupported_initial_data {
  std::string key,           ///< of the case, that must change; "" if all is well
      problem;               ///< message; "" if all is well
  std::string reached = {};  ///< message where a run, not its data, reaches the state; "": the same
};

/// An equation u_t + Σ_k ∂_xk(v_k u) = S(u) + Q(u)/ε at one point of space, independent of mesh and time. A
/// row u has components() values; all quantities are dimensionless.
class model : public construction_count<model> {
 public:
  virtual ~model() = default;

  /// Returns this model as a relaxation towards E(ω); null for other models.
  virtual const relaxation_model* as_relaxation() const { return nullptr; }
  /// Returns this model as that of a gas with density, velocity and temperature; null for other models.
  virtual const gas_model* as_gas() const { return nullptr; }

  /// Returns the number of components of a row.
  virtual int components() const = 0;
  /// Returns D; 0 for an ordinary differential equation.
  virtual int space_dimensions() const = 0;
  /// Returns the velocities that transport the components; empty without space.
  virtual const velocity_set& velocities() const;
  /// Returns the transport speed of every component along a direction; empty without space.
  std::span<const double> speeds(int direction) const { return velocities().speeds(direction); }
  /// Returns the lattice of the velocities, along which forces act; none by default.
  virtual velocity_lattice lattice() const { return {}; }
  /// Returns the rings of the velocities, which axisymmetric flow needs; none by default.
  virtual polar_layout polar() const { return {}; }
  /// Whether Q(cu) = c²Q(u) for c > 0, as where the rate of collisions is proportional to the density. The
  /// alternative, the default, is Q(cu) = c Q(u). Used for models with rings of velocities alone.
  virtual bool rate_is_proportional_to_density() const { return false; }
  /// Returns R of the CFL number R Δt on cells of the given sizes Δx_k: by default max_j Σ_k |v_jk|/Δx_k,
  /// since every component moves with one velocity.
  virtual double cfl_rate(std::span<const double> spacing) const;

  /// Returns the factors of the sets of components on velocities() under a reflection of a direction of
  /// space: −1 for a set whose sum is a momentum along it; empty, the default: 1 for all. Throws input_error
  /// if they are unknown.
  virtual std::vector<double> reflection_signs(int /*direction*/) const { return {}; }

  /// Whether S(u) is not identically 0.
  virtual bool has_source() const { return false; }
  /// s ← S(u), the explicit local source, part of the operator T; 0 by default.
  virtual void source(const double* u, double* s) const;

  /// Returns a solver of collisions at points with scratch memory for one thread and batches within `limits`.
  /// The model must outlive it.
  virtual std::unique_ptr<point_collision> make_collision(const batch_limits& limits) const = 0;
  /// Whether make_collision() provides the exact solution of v' = Q(v)/ε.
  virtual bool has_exact_collision() const { return false; }
  /// Whether make_collision() provides the relaxation time ε/C.
  virtual bool has_relaxation_time() const { return false; }
  /// Returns the number n of unknowns of the systems that Newton's method solves at a point, with n³
  /// operations each; 0 if stages are closed formulas.
  virtual int newton_unknowns() const { return 0; }

  /// Whether components are nonnegative by definition, so that positivity can be promised.
  virtual bool positive() const { return false; }
  /// Whether stage solves keep nonnegative rows nonnegative.
  virtual bool collisions_keep_sign() const { return positive(); }
  /// Returns a message if stage solves make rows negative by choice of the user: "positivity is not promised
  /// (…); …"; "" otherwise.
  virtual std::string why_signed() const { return {}; }
  /// Returns the name of the moments whose relaxation point_collision::take_cut() compares with that of the
  /// published model: "heat_flux"; "", the default, of a model whose target is never changed.
  virtual std::string cut_moment() const { return {}; }
  /// Returns the entropy; nothing, the default, where none is known. The model must outlive it.
  virtual std::optional<convex_entropy> entropy() const { return {}; }

  /// Returns the names of the quantities, linear in u, that collisions and periodic transport conserve; may
  /// be empty.
  virtual std::vector<std::string> invariants() const = 0;
  /// densities ← the densities of the invariants of a row, in the order of invariants().
  virtual void invariant_densities(const double* u, double* densities) const = 0;
  /// Returns the dimensions of the densities of the invariants in units of a gas; numbers by default.
  virtual std::vector<dimension> invariant_dimensions() const;
  /// scales ← the sizes of the sums behind the invariants, to which rounding is relative; |densities| by
  /// default. A momentum may vanish by cancellation of particles that move in opposite directions.
  virtual void invariant_scales(std::span<const double> densities, double* scales) const;

  /// Returns the macroscopic fields. Results have those of the first group, which needs no gradients, unless
  /// output.fields names others. The model must outlive them.
  virtual std::vector<field_group> fields() const = 0;
  /// Returns the fields of the first group.
  std::vector<field_name> default_fields() const { return fields().front().names; }
  /// values ← the fields of the first group. Loops over rows call its compute() instead, since this function
  /// makes the groups.
  void macroscopic(const double* u, double* values) const { fields().front().compute({u}, values); }

  /// Returns the initial data; the first is the default. A model of a registry has some with its default
  /// options; where others leave none, a case needs a table [initial].
  virtual const std::vector<initial_data>& initial() const = 0;
  /// Returns the ways to prescribe a row by variables, the preferred one first; none by default. The model
  /// must outlive them.
  virtual std::vector<data_form> data_forms() const;

  /// Returns why the discrete model (its velocity grid) cannot represent a row of data, and a remedy.
  virtual unsupported_initial_data check_supported(const double* u) const;
  /// Returns the name of the condition that check_supported() states, if a solution may violate it later, so
  /// that a run checks it after every step: "subcharacteristic condition"; "" without one.
  virtual std::string condition() const { return ""; }
  /// Returns the same for data whose default fields lie between these extremes.
  virtual unsupported_initial_data check_supported_range(const double* lowest, const double* highest) const;

  /// Returns the value of an automatic parameter (model_parameter::automatic) for initial data with
  /// the samples `rows`. Throws input_error where none suits them.
  virtual double automatic_value(const std::string& parameter,
                                 const std::vector<std::vector<double>>& rows) const;
};

/// Whether the model has an entropy that no stage solve of a collision increases.
inline bool collisions_decrease_entropy(const model& equation) {
  const auto entropy = equation.entropy();
  return entropy && entropy->collisions_decrease;
}

/// Q(u) = C(ω)(E − u) with ω = ℛu and ℛQ = 0 (paper, Properties 3–5); every stage is solved in closed form.
/// The target is the equilibrium E(ω), or depends also on moments s of u that relax: then 𝒮E(ω, s) = (1 −
/// λ)s, and s is the deviation from equilibrium (docs/models.md).
class relaxation_model : public model {
 public:
  const relaxation_model* as_relaxation() const final { return this; }
  /// Returns the length of ω.
  virtual int moment_count() const = 0;
  /// ω ← ℛu.
  virtual void moments(const double* u, double* omega) const = 0;
  /// e ← E(ω). Returns false if ω is not admissible (NaN, ρ ≤ 0, T ≤ 0, …); e is then undefined.
  virtual bool equilibrium(const double* omega, double* e) const = 0;
  /// moments() of several rows, `pitch` numbers apart. The results equal those of single rows, which the
  /// default calls; a model overrides it if several rows together are faster.
  virtual void moments_of_rows(const double* u, std::ptrdiff_t pitch, int rows, double* omega) const;
  /// equilibrium() of several rows; returns the number of rows before the first ω that is not admissible.
  virtual int equilibria(const double* omega, int rows, double* e, std::ptrdiff_t pitch) const;
  /// Returns the length of s; 0 if the target is the equilibrium.
  virtual int relaxing_count() const { return 0; }
  /// Returns the largest relative difference of the moments of an equilibrium or a target from ω: four
  /// roundings.
  virtual double moment_accuracy() const { return 4.5e-16; }
  /// s ← the relaxing moments of a row with moments ω.
  virtual void relaxing_moments(const double* u, const double* omega, double* s) const;
  /// s ← those of the solution of a stage whose explicit part has s, σ/(1 + λA + λ²B), and what target()
  /// needs of the derivative Q̇ in the stage, of weight λB/(A + B).
  virtual void relax(const stage_coefficients& strength, double* s) const;
  /// e ← E(ω, s) + λB/(A + B) E_s s, the target of a stage after relax(), or E(ω, s), for a row u ≥ 0. Where
  /// it is less than −keep·u, a model that keeps the sign changes it, so that the solution of the stage is
  /// not negative; keep = 0 for an explicit Q(u), whose forward Euler step ends at the target. `cut`: the
  /// relative change of the rate at which s relaxes, where e is another target (cut_moment()); otherwise it
  /// stays. Returns false if ω is not admissible.
  virtual bool target(const double* omega, const double* s, const double* u, double keep, double* e,
                      double& cut) const;
  /// Returns C(ω) > 0.
  virtual double rate(const double* omega) const = 0;
  std::unique_ptr<point_collision> make_collision(const batch_limits& limits) const final;
  /// E(ω) does not change during a collision, but targets of moments that relax do.
  bool has_exact_collision() const final { return relaxing_count() == 0; }
  bool has_relaxation_time() const final { return true; }
  /// Returns the reason for a message: "temperature -0.3 is not positive".
  virtual std::string why_inadmissible(const double* omega) const = 0;
  /// Returns the operation count (exec/counted.hpp) of ℛu and E(ω) per component; 0, the default: not
  /// counted.
  virtual double operations_of_equilibrium() const { return 0.0; }
};

}  // namespace apsis
