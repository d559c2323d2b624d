#pragma once

#include <apsis/boundary/domain.hpp>
#include <apsis/model/model.hpp>
#include <apsis/semidiscrete/discretization_registry.hpp>
#include <apsis/semidiscrete/semidiscrete_problem.hpp>

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace apsis {

/// Builds the semi-discrete problem u' = T(t, u) + Q(u)/ε of a model from C++ objects:
///
///   auto problem = problem_builder(equation)
///                      .on(grid::line(40, 0.0, 2.0))
///                      .with_reconstruction(find_reconstruction("weno5-z").make())
///                      .with_positivity_limiter()
///                      .with_epsilon([](const position& x) { return 1e-3 + x[0] * x[0]; })
///                      .build();
///
/// Defaults: cell averages on a line, point values in several dimensions, periodic faces, no limiter, ε = 1.
/// A model without space needs no mesh. All quantities are dimensionless.
class problem_builder {
 public:
  /// ε at a point of space, finite and ≥ 0; 0 is the limit system.
  using scale = std::function<double(const position&)>;
  /// u ← the components at a point of space; at a jump, those of its right side.
  using data = state_function;

  /// `equation` must outlive the builder and what it builds.
  explicit problem_builder(const model& equation);

  /// Sets the mesh. Throws input_error if the model has another number of space dimensions.
  problem_builder& on(const grid& mesh);
  /// Shares the mesh, which must be set before, among processes: mesh() is then the block of this one.
  /// `blocks`: numbers of blocks along each direction, by default those with the smallest surfaces. Throws
  /// input_error if the mesh cannot be shared so, or the model has no space.
  problem_builder& shared_by(std::shared_ptr<communicator> processes,
                             const std::optional<std::array<int, 3>>& blocks = std::nullopt);
  /// Sets the boundary of one face of the mesh, which must be set before; the default is periodic.
  problem_builder& with_boundary(const face& where, std::shared_ptr<const boundary> side);
  /// Sets the boundary at a solid box or body of the mesh (grid::solid()), which must be set before; each
  /// needs one.
  problem_builder& with_solid(int number, std::shared_ptr<const boundary> wall);
  /// Sets the reconstruction scheme. Throws input_error if the mesh, which must be set before, is smaller
  /// than its stencil.
  problem_builder& with_reconstruction(std::shared_ptr<const reconstruction> scheme);
  /// Sets the discretization of space. Throws input_error with the nearest name for an unknown
  /// one.
  problem_builder& with_discretization(const std::string& name);
  /// Sets a discretization of space that has no entry in the registry.
  problem_builder& with_discretization(std::shared_ptr<const discretization> of_space);
  /// Keeps nonnegative data nonnegative for steps up to r Δt_FE. Throws input_error if the unknowns of the
  /// model may be negative.
  problem_builder& with_positivity_limiter();
  /// Sets where cells collide: one of discretization::collision_places(), the first by default.
  problem_builder& with_collisions_at(const std::string& place);
  /// Sets ε(x).
  problem_builder& with_epsilon(scale epsilon);
  /// Multiplies the ε(x) that is set by a factor.
  problem_builder& with_epsilon_times(double factor);
  /// Adds the force −a·∇_v f of an acceleration, on models whose velocities are a lattice.
  problem_builder& with_force(acceleration of);
  /// Adds a source S(t, x) of rows, on models with space.
  problem_builder& with_source(source_rate rate);
  /// Makes the flow axisymmetric. The direction `radial` of the mesh, the last of one or two, is then
  /// that of the distance r from the axis. The unknowns are F = r f. Data, ε,
  /// boundaries and sources are still those of f. The lower end of r is the boundary "axis" if it is r = 0.
  problem_builder& with_axis(int radial);
  /// For methods that keep no signs: collisions at centres are not limited then. Limited averages are no
  /// smooth function of the data, as small errors need, and their Q is not that of the stage.
  problem_builder& with_smooth_collisions();
  /// For methods that treat T and Q explicitly: forward_euler_step() is then that of T + Q/ε.
  problem_builder& with_explicit_collision();
  /// For methods with exact collisions: stage solves of the problem are exact solutions of the collision.
  /// Throws input_error if the model does not know them.
  problem_builder& with_exact_collision();
  /// Undoes with_exact_collision().
  problem_builder& with_implicit_collision();

  /// Returns the problem. Throws input_error if
  /// - the mesh or the reconstruction is missing;
  /// - ε is not a finite number ≥ 0;
  /// - only one face of a direction is periodic;
  /// - the discretization does not serve the dimensions, the solid boxes or the place of collisions;
  /// - the force is not possible (force.hpp);
  /// - axisymmetric flow is not possible (axisymmetric.hpp) or has a force, or there is an axis without it.
  std::unique_ptr<semidiscrete_problem> build() const;
  /// Returns the unknowns of data (cell_unknown), [cells][components], 0 in solid cells; averages are exact
  /// to rounding if the data are smooth between the `jumps` (in increasing order). In axisymmetric flow they
  /// are those of r f.
  field sample(const data& value, const std::vector<double>& jumps = {}) const;

  /// Whether the model has space.
  bool has_space() const { return equation_->space_dimensions() > 0; }
  /// Returns the mesh, or the block of this process; a single cell without space.
  const grid& mesh() const { return mesh_; }
  /// Returns the mesh of all processes.
  const grid& whole_mesh() const { return distribution_ ? distribution_->whole : mesh_; }
  /// Returns the processes that share the mesh.
  communicator& processes() const { return *processes_; }
  /// Returns the blocks of a mesh that several processes share; nothing for a single one.
  const std::optional<distribution>& blocks() const { return distribution_; }
  /// Returns the domain, without ghost rows; the first problem that is built uses it. Throws input_error if
  /// only one face of a direction is periodic.
  const domain& space() const;
  /// Returns the domain of the whole mesh, also on one of several processes.
  const domain& whole_space() const;
  /// Returns a new domain, for ghost rows of its own.
  std::shared_ptr<domain> make_space() const;
  /// Whether the reconstruction is first-order upwind.
  bool first_order() const { return scheme_ && scheme_->order() == 1; }
  /// Returns the number of ghost rows of transport beyond the end of a segment, of point values.
  int ghost_rows() const;
  /// Whether steps within r Δt_FE keep nonnegative data nonnegative.
  bool keeps_sign() const { return limited_ || first_order() || !has_space(); }
  /// Returns κ of Δt_FE = κ / max Σ_k |v_k|/Δx_k: 1 without the positivity limiter and bodies.
  double cfl_number() const;
  /// Returns R of the CFL number R Δt: model::cfl_rate(), or in axisymmetric flow the largest rate with the
  /// rotation next to the axis (ring_rotation::rates_with()). Requires a mesh and a reconstruction.
  double cfl_rate() const;
  /// Returns the force; nothing without one.
  const std::optional<acceleration>& force() const { return force_; }
  /// Returns the source of with_source(); nothing without one.
  const std::optional<source_rate>& source() const { return source_; }
  /// Returns the direction of r in axisymmetric flow; nothing in other flows.
  const std::optional<int>& axis() const { return radial_; }
  /// Returns the discretization of space; that of a point without space.
  const discretization& of_space() const;
  /// Returns where cells collide. Requires a reconstruction if the model has space.
  collision_layout collisions() const;
  /// Returns ε at the cell centres, as it is set, also in axisymmetric flow. Throws input_error if it is not
  /// a finite number ≥ 0.
  std::vector<double> epsilon_at_centres() const;

 private:
  void forget_spaces() { space_ = whole_ = nullptr; }
  void check_solids() const;
  void check_cells() const;
  void check_discretization() const;
  std::shared_ptr<domain> make_domain_of(const grid& mesh, const distribution* shared) const;
  std::vector<double> epsilon_at(std::span<const weighted_point> points, const scale& epsilon) const;

  const model* equation_;
  grid mesh_;
  std::shared_ptr<communicator> processes_ = single_process();
  std::optional<distribution> distribution_;
  std::vector<domain::faces> sides_;
  std::vector<std::shared_ptr<const boundary>> solids_;
  std::shared_ptr<const reconstruction> scheme_;
  const discretization_entry* discretization_ = nullptr;      ///< null: the default
  std::shared_ptr<const discretization> own_discretization_;  ///< null: that of the entry
  std::string collisions_;                                    ///< "": the default
  bool limited_ = false, explicit_collision_ = false, smooth_collisions_ = false;
  stage_solution stages_ = stage_solution::implicit;
  scale epsilon_;
  std::optional<acceleration> force_;
  std::optional<source_rate> source_;
  std::optional<int> radial_;
  mutable std::shared_ptr<domain> space_, whole_;  ///< made when first asked for; none after a change
};

}  // namespace apsis
