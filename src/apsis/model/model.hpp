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
  apsis::dimension dimension = {};  ///< dimension that gives its unit for a gas (gas_scales.hpp)
};

/// A cell of a mesh, with the values that its fields depend on.
struct field_point {
  const double* u;       ///< its row
  double epsilon = 0.0;  ///< ε at its centre
  /// (∂_x φ, ∂_y φ, ∂_z φ) of every field φ of model::default_fields(); 0 along directions without space.
  /// Empty unless the group needs gradients.
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
  /// u ← all components at x. At a jump they are the values on the side of larger coordinates.
  std::function<void(const position& x, std::span<double> u)> point_value;
  /// u ← the smooth exact solution at t and x; empty if no formula is known.
  std::function<void(double t, const position& x, std::span<double> u)> exact = {};
  std::vector<double> jumps = {};  ///< discontinuities of data on a line, in increasing order
};

/// A tensor product of velocities: all combinations of points in each of d directions, with the last
/// direction fastest.
struct velocity_lattice {
  std::vector<int> points;      ///< n_k of each direction; empty if the velocities are not a lattice
  std::vector<double> spacing;  ///< Δv_k; 0 if the points are not equidistant
};

/// The problem with data that a model cannot represent.
struct unsupported_initial_data {
  std::string key,           ///< key of the case that must change; "" without a problem
      problem;               ///< message; "" without a problem
  std::string reached = {};  ///< message if a run reaches the state later; "": `problem`
};

/// An equation u_t + Σ_k ∂_xk(v_k u) = S(u) + Q(u)/ε at one point of space, independent of mesh and time. A
/// row u has components() values; all quantities are dimensionless.
class model : public construction_count<model> {
 public:
  virtual ~model() = default;

  /// Returns this model as a relaxation towards E(ω); null for other models.
  virtual const relaxation_model* as_relaxation() const { return nullptr; }
  /// Returns this model as a gas with density, velocity and temperature; null for other models.
  virtual const gas_model* as_gas() const { return nullptr; }

  /// Returns the number of components of a row.
  virtual int components() const = 0;
  /// Returns the number D of space dimensions; 0 for an ordinary differential equation.
  virtual int space_dimensions() const = 0;
  /// Returns the velocities that transport the components; empty without space.
  virtual const velocity_set& velocities() const;
  /// Returns the transport speed of every component along a direction; empty without space.
  std::span<const double> speeds(int direction) const { return velocities().speeds(direction); }
  /// Returns the lattice of the velocities, which forces need; empty by default.
  virtual velocity_lattice lattice() const { return {}; }
  /// Returns the rings of the velocities, which axisymmetric flow needs; empty by default.
  virtual polar_layout polar() const { return {}; }
  /// Whether Q(cu) = c²Q(u) for c > 0, because the collision rate is proportional to the density. By default
  /// Q(cu) = c Q(u). Matters only for models with rings of velocities.
  virtual bool rate_is_proportional_to_density() const { return false; }
  /// Returns the CFL rate R on cells of the given sizes Δx_k: the CFL number is R Δt. By default R = max_j
  /// Σ_k |v_jk|/Δx_k, because every component moves with one velocity.
  virtual double cfl_rate(std::span<const double> spacing) const;

  /// Returns the factors by which a reflection of a direction of space multiplies the sets of components on
  /// velocities(). The factor is −1 for a set whose sum is a momentum along this direction. Empty, the
  /// default, means 1 for all sets. Throws input_error if the factors are unknown.
  virtual std::vector<double> reflection_signs(int /*direction*/) const { return {}; }

  /// Whether S(u) is not identically 0.
  virtual bool has_source() const { return false; }
  /// s ← S(u), the explicit local source, which is part of the operator T; 0 by default.
  virtual void source(const double* u, double* s) const;

  /// Returns a solver of collisions at points, for batches within `limits`. It has scratch memory for one
  /// thread. The model must outlive it.
  virtual std::unique_ptr<point_collision> make_collision(const batch_limits& limits) const = 0;
  /// Whether make_collision() provides the exact solution of v' = Q(v)/ε.
  virtual bool has_exact_collision() const { return false; }
  /// Whether make_collision() provides the relaxation time ε/C.
  virtual bool has_relaxation_time() const { return false; }
  /// Returns the number n of unknowns of the systems that Newton's method solves at a point, in O(n³)
  /// operations. Returns 0 if stages have closed formulas.
  virtual int newton_unknowns() const { return 0; }

  /// Whether components are nonnegative by definition, so that a run can promise positivity.
  virtual bool positive() const { return false; }
  /// Whether stage solves keep nonnegative rows nonnegative.
  virtual bool collisions_keep_sign() const { return positive(); }
  /// Returns a message if stage solves may make rows negative because of an option of the user: "positivity
  /// is not promised (…); …". Returns "" otherwise.
  virtual std::string why_signed() const { return {}; }
  /// Returns the name of the moments, such as "heat_flux", whose relaxation changes if the target is cut off.
  /// point_collision::take_cut() measures the change relative to the published model. Returns "", the
  /// default, if the target is never cut off.
  virtual std::string cut_moment() const { return {}; }
  /// Returns the entropy; nothing, the default, if no entropy is known. The model must outlive it.
  virtual std::optional<convex_entropy> entropy() const { return {}; }

  /// Returns the names of the quantities, linear in u, that collisions and periodic transport conserve. May
  /// be empty.
  virtual std::vector<std::string> invariants() const = 0;
  /// densities ← the densities of the invariants of a row, in the order of invariants().
  virtual void invariant_densities(const double* u, double* densities) const = 0;
  /// Returns the dimensions of the densities of the invariants, which give their units for a gas;
  /// dimensionless by default.
  virtual std::vector<dimension> invariant_dimensions() const;
  /// scales ← the sizes of the sums that give the invariants; rounding errors are relative to them. By
  /// default they are the absolute densities. A momentum needs a larger scale, because particles that move in
  /// opposite directions cancel.
  virtual void invariant_scales(std::span<const double> densities, double* scales) const;

  /// Returns the macroscopic fields. By default (output.fields) results have the first group, which needs no
  /// gradients. The model must outlive the fields.
  virtual std::vector<field_group> fields() const = 0;
  /// Returns the fields of the first group.
  std::vector<field_name> default_fields() const { return fields().front().names; }
  /// values ← the fields of the first group. Loops over rows should call fields().front().compute() instead,
  /// because this function constructs the groups at every call.
  void macroscopic(const double* u, double* values) const { fields().front().compute({u}, values); }

  /// Returns the initial data; the first is the default. Every registered model has initial data with its
  /// default options. If other options leave none, a case needs a table [initial].
  virtual const std::vector<initial_data>& initial() const = 0;
  /// Returns the ways to prescribe a row by variables, the preferred one first; empty by default. The model
  /// must outlive them.
  virtual std::vector<data_form> data_forms() const;

  /// Returns why the discrete model, such as its velocity grid, cannot represent a row of data, and a remedy.
  virtual unsupported_initial_data check_supported(const double* u) const;
  /// Returns the name of the condition of check_supported() if a solution may violate it later:
  /// "subcharacteristic condition". A run then checks it after every step. Returns "" without such
  /// a condition.
  virtual std::string condition() const { return ""; }
  /// Returns the result of check_supported() for data whose default fields lie between `lowest`
  /// and `highest`.
  virtual unsupported_initial_data check_supported_range(const double* lowest, const double* highest) const;

  /// Returns the value of an automatic parameter (model_parameter::automatic) for initial data with the
  /// samples `rows`; NaN by default. Throws input_error if no value suits the data.
  virtual double automatic_value(const std::string& parameter,
                                 const std::vector<std::vector<double>>& rows) const;
};

/// Whether the model has an entropy that no stage solve of a collision increases.
inline bool collisions_decrease_entropy(const model& equation) {
  const auto entropy = equation.entropy();
  return entropy && entropy->collisions_decrease;
}

/// A relaxation Q(u) = C(ω)(E − u) with ω = ℛu and ℛQ = 0 (paper, Properties 3–5). Every stage has a closed
/// formula. The target E is the equilibrium E(ω), or E(ω, s) if it also depends on moments s = 𝒮u that relax.
/// Then 𝒮E(ω, s) = (1 − λ)s, and s is a deviation from equilibrium (docs/models.md).
class relaxation_model : public model {
 public:
  const relaxation_model* as_relaxation() const final { return this; }
  /// Returns the length of ω.
  virtual int moment_count() const = 0;
  /// ω ← ℛu.
  virtual void moments(const double* u, double* omega) const = 0;
  /// e ← E(ω). Returns false if ω is not admissible (NaN, ρ ≤ 0, T ≤ 0, …); e is then undefined.
  virtual bool equilibrium(const double* omega, double* e) const = 0;
  /// Computes moments() of several rows, which lie `pitch` numbers apart. The results equal those of single
  /// rows. The default calls moments() row by row; a model overrides it if several rows together are faster.
  virtual void moments_of_rows(const double* u, std::ptrdiff_t pitch, int rows, double* omega) const;
  /// Computes equilibrium() of several ω into rows that lie `pitch` numbers apart. Returns the number of rows
  /// before the first ω that is not admissible.
  virtual int equilibria(const double* omega, int rows, double* e, std::ptrdiff_t pitch) const;
  /// Returns the length of s; 0 if the target is the equilibrium.
  virtual int relaxing_count() const { return 0; }
  /// Returns a bound on the relative difference between ω and the moments of an equilibrium or a target: by
  /// default four roundings.
  virtual double moment_accuracy() const { return 4.5e-16; }
  /// s ← the relaxing moments 𝒮u of a row with moments ω.
  virtual void relaxing_moments(const double* u, const double* omega, double* s) const;
  /// Replaces the relaxing moments s of the explicit part of a stage by those of its solution, s/(1
  /// + λA + λ²B). Also stores the weight λB/(A + B) of Q̇, which target() needs. A and B are those
  /// of stage_coefficients.
  virtual void relax(const stage_coefficients& strength, double* s) const;
  /// e ← E(ω, s) + λB/(A + B) E_s s, the target of a stage after relax(), for a row u ≥ 0; without Q̇ it is
  /// E(ω, s). A model that keeps the sign changes the target where it is less than −keep·u, so that the
  /// solution of the stage stays nonnegative. An explicit Q(u) has keep = 0, because its forward Euler step
  /// ends at the target.
  ///
  /// If e is not the published target, cut ← the relative change of the rate at which s relaxes
  /// (cut_moment()). Otherwise `cut` is unchanged. Returns false if ω is not admissible.
  virtual bool target(const double* omega, const double* s, const double* u, double keep, double* e,
                      double& cut) const;
  /// Returns C(ω) > 0.
  virtual double rate(const double* omega) const = 0;
  std::unique_ptr<point_collision> make_collision(const batch_limits& limits) const final;
  /// A collision preserves E(ω), but changes targets that depend on relaxing moments.
  bool has_exact_collision() const final { return relaxing_count() == 0; }
  bool has_relaxation_time() const final { return true; }
  /// Returns the reason why ω is not admissible, for messages: "temperature -0.3 is not positive".
  virtual std::string why_inadmissible(const double* omega) const = 0;
  /// Returns the operation count (exec/counted.hpp) of ℛu and E(ω) per component; 0, the default, if it
  /// is unknown.
  virtual double operations_of_equilibrium() const { return 0.0; }
};

}  // namespace apsis
