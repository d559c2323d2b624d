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
/// Defaults are cell averages on a line, point values in several dimensions, periodic faces, no limiter, and
/// ε = 1. A model without space needs no mesh. All quantities are dimensionless.
class problem_builder {
 public:
  /// Returns ε at a point of space, finite and ≥ 0; 0 gives the limit system.
  using scale = std::function<double(const position&)>;
  /// u ← the components at a point of space. At a jump it takes the values of the right side.
  using data = state_function;

  /// `equation` must outlive the builder and the problems that it builds.
  explicit problem_builder(const model& equation);

  /// Sets the mesh. Throws input_error if the model has another number of space dimensions.
  problem_builder& on(const grid& mesh);
  /// Shares the mesh, which must be set before, among processes. mesh() is then the block of this process.
  /// `blocks` are the numbers of blocks along each direction; the default has the smallest surfaces. Throws
  /// input_error if these blocks are not possible, or if the model has no space.
  problem_builder& shared_by(std::shared_ptr<communicator> processes,
                             const std::optional<std::array<int, 3>>& blocks = std::nullopt);
  /// Sets the boundary of one face of the mesh, which must be set before; the default is periodic. Throws
  /// input_error if there is no such face.
  problem_builder& with_boundary(const face& where, std::shared_ptr<const boundary> side);
  /// Sets the boundary at a solid box or body of the mesh (grid::solid()), which must be set before. Each
  /// solid needs one. Throws input_error if there is no such solid.
  problem_builder& with_solid(int number, std::shared_ptr<const boundary> wall);
  /// Sets the reconstruction scheme. Throws input_error if the mesh is smaller than its stencil; the mesh
  /// must be set before.
  problem_builder& with_reconstruction(std::shared_ptr<const reconstruction> scheme);
  /// Sets the discretization of space by name. Throws input_error with the nearest name for an unknown one.
  problem_builder& with_discretization(const std::string& name);
  /// Sets a discretization of space that has no entry in the registry.
  problem_builder& with_discretization(std::shared_ptr<const discretization> of_space);
  /// Keeps nonnegative data nonnegative for steps up to r Δt_FE. Throws input_error if the unknowns of the
  /// model may be negative.
  problem_builder& with_positivity_limiter();
  /// Sets the place at which cells collide, from discretization::collision_places(); the default is
  /// the first one.
  problem_builder& with_collisions_at(const std::string& place);
  /// Sets ε(x).
  problem_builder& with_epsilon(scale epsilon);
  /// Multiplies the current ε(x) by a factor.
  problem_builder& with_epsilon_times(double factor);
  /// Adds the force −a·∇_v f of an acceleration a, for models with a lattice of velocities.
  problem_builder& with_force(acceleration of);
  /// Adds a source S(t, x) of rows. Throws input_error if the model has no space.
  problem_builder& with_source(source_rate rate);
  /// Makes the flow axisymmetric. The direction `radial` of the mesh, the last of one or two, is then the
  /// distance r from the axis. The unknowns are F = r f. Data, ε, boundaries and sources are still those of
  /// f. The lower end of r must be the boundary "axis" if it is r = 0.
  problem_builder& with_axis(int radial);
  /// For methods that do not preserve signs: collisions at centres are then not limited. Small errors need
  /// averages that are smooth functions of the data, but limited averages are not. The Q of limited averages
  /// also differs from that of the stage.
  problem_builder& with_smooth_collisions();
  /// For methods that treat T and Q explicitly: forward_euler_step() is then the step of T + Q/ε.
  problem_builder& with_explicit_collision();
  /// For methods with exact collisions: stage solves are then exact solutions of the collision. Throws
  /// input_error if the model has no exact collision.
  problem_builder& with_exact_collision();
  /// Undoes with_exact_collision().
  problem_builder& with_implicit_collision();

  /// Returns the problem. Throws input_error if
  /// - the mesh or the reconstruction is missing;
  /// - ε is not a finite number ≥ 0;
  /// - only one face of a direction is periodic;
  /// - the discretization does not support the dimensions, the solid boxes or the place of collisions;
  /// - the force is not possible (force.hpp);
  /// - axisymmetric flow is not possible (axisymmetric.hpp) or has a force, or another flow has an axis.
  std::unique_ptr<semidiscrete_problem> build() const;
  /// Returns the unknowns of data (cell_unknown), [cells][components], 0 in solid cells. Averages are exact
  /// to rounding if the data are smooth between the `jumps` (in increasing order). In axisymmetric flow they
  /// are the unknowns of r f.
  field sample(const data& value, const std::vector<double>& jumps = {}) const;

  /// Returns true if the model has space.
  bool has_space() const { return equation_->space_dimensions() > 0; }
  /// Returns the mesh or the block of this process; a single cell if the model has no space.
  const grid& mesh() const { return mesh_; }
  /// Returns the mesh of all processes.
  const grid& whole_mesh() const { return distribution_ ? distribution_->whole : mesh_; }
  /// Returns the processes that share the mesh.
  communicator& processes() const { return *processes_; }
  /// Returns the blocks of a mesh that several processes share; nothing for a single process.
  const std::optional<distribution>& blocks() const { return distribution_; }
  /// Returns the domain, without ghost rows. The first problem uses it. Throws input_error if only one face
  /// of a direction is periodic.
  const domain& space() const;
  /// Returns the domain of the whole mesh, even if several processes share it.
  const domain& whole_space() const;
  /// Returns a new domain with ghost rows of its own.
  std::shared_ptr<domain> make_space() const;
  /// Returns true if the reconstruction is first-order upwind.
  bool first_order() const { return scheme_ && scheme_->order() == 1; }
  /// Returns the number of ghost rows of transport beyond the end of a segment, for point values.
  int ghost_rows() const;
  /// Returns true if steps within r Δt_FE keep nonnegative data nonnegative.
  bool keeps_sign() const { return limited_ || first_order() || !has_space(); }
  /// Returns κ of Δt_FE = κ / max Σ_k |v_k|/Δx_k. It is 1 without the positivity limiter and bodies.
  double cfl_number() const;
  /// Returns R of the CFL number R Δt, which is model::cfl_rate(). In axisymmetric flow it is the
  /// largest rate with the rotation next to the axis (ring_rotation::rates_with()). Requires a mesh
  /// and a reconstruction.
  double cfl_rate() const;
  /// Returns the force, if any.
  const std::optional<acceleration>& force() const { return force_; }
  /// Returns the source of with_source(), if any.
  const std::optional<source_rate>& source() const { return source_; }
  /// Returns the direction of r in axisymmetric flow; nothing in other flows.
  const std::optional<int>& axis() const { return radial_; }
  /// Returns the discretization of space; for a model without space, that of a point.
  const discretization& of_space() const;
  /// Returns the layout of collisions. Requires a reconstruction if the model has space.
  collision_layout collisions() const;
  /// Returns ε at the cell centres as it was set, even in axisymmetric flow. Throws input_error if a value is
  /// not a finite number ≥ 0.
  std::vector<double> epsilon_at_centres() const;
  /// Returns ε at the cell centres for the unknowns of the problem, which are F = r f in axisymmetric flow.
  /// Throws as epsilon_at_centres() does.
  std::vector<double> epsilon_of_unknowns() const;

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
  mutable std::shared_ptr<domain> space_, whole_;  ///< made on first use; null after a change
};

}  // namespace apsis
