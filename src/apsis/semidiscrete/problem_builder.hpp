#pragma once

#include <apsis/model/model.hpp>
#include <apsis/phase/domain.hpp>
#include <apsis/scheme/formulation.hpp>
#include <apsis/semidiscrete/semidiscrete_problem.hpp>

#include <functional>
#include <memory>
#include <span>
#include <vector>

namespace apsis {

/// Makes the semi-discrete problem u' = T(t, u) + Q(u)/ε of a model from C++ objects:
///
///   auto problem = problem_builder(equation)
///                      .on(grid::line(40, 0.0, 2.0))
///                      .with_reconstruction(find_reconstruction("weno5-z")->make())
///                      .with_positivity_limiter()
///                      .with_epsilon([](const position& x) { return 1e-3 + x[0] * x[0]; })
///                      .build();
///
/// Defaults: cell averages, periodic faces, no limiter, ε = 1. A model without space needs no mesh. All
/// quantities are dimensionless.
class problem_builder {
 public:
  /// ε at a point of space, finite and ≥ 0; 0 is the limit system.
  using scale = std::function<double(const position&)>;
  /// u ← the components at a point of space; at a jump, those of its right side.
  using data = std::function<void(const position&, std::span<double> u)>;

  /// `equation` must outlive the builder and what it builds.
  explicit problem_builder(const model& equation);

  /// The mesh. Throws input_error where the model has no space, or another number of dimensions.
  problem_builder& on(const grid& mesh);
  /// What lies beyond one face of the mesh, which must be known; periodic without it.
  problem_builder& with_boundary(const face& where, std::shared_ptr<const boundary> side);
  /// The scheme of edge values. Throws input_error where the mesh, which must be known, is smaller than its
  /// stencil.
  problem_builder& with_reconstruction(std::shared_ptr<const reconstruction> scheme);
  /// What the unknowns are.
  problem_builder& with_unknowns(formulation unknowns);
  /// Keeps nonnegative data nonnegative for steps up to r Δt_FE. Throws input_error where the unknowns of the
  /// model may be negative.
  problem_builder& with_positivity_limiter();
  /// ε(x).
  problem_builder& with_epsilon(scale epsilon);
  /// For methods that treat T and Q explicitly: Δt_FE is then that of T + Q/ε.
  problem_builder& with_explicit_collision();

  /// Throws input_error where a mesh or a reconstruction is missing, ε is no finite number ≥ 0, only one face
  /// of a direction is periodic, or averages are asked for in more than one space dimension.
  std::unique_ptr<semidiscrete_problem> build() const;
  /// Cell averages or point values of data, [cells][components]; averages are exact to rounding where the
  /// data are smooth between the `jumps` (in increasing order).
  field sample(const data& value, const std::vector<double>& jumps = {}) const;

  /// Whether the model has space.
  bool has_space() const { return equation_->space_dimensions() > 0; }
  /// The mesh; a single cell without space.
  const grid& mesh() const { return mesh_; }
  /// The mesh with its faces. Throws input_error where only one face of a direction is periodic.
  domain space() const;
  /// Whether the reconstruction is first-order upwind.
  bool first_order() const { return how_.scheme && how_.scheme->order() == 1; }
  /// Whether steps within r Δt_FE keep nonnegative data nonnegative.
  bool keeps_sign() const { return limited_ || first_order() || !has_space(); }
  /// ε at the cell centres. Throws input_error where it is no finite number ≥ 0.
  std::vector<double> epsilon_at_centres() const;

 private:
  bool pointwise() const;
  stencil complete_stencil() const;
  std::vector<double> epsilon_at(std::span<const double> offsets) const;
  std::unique_ptr<collision> make_collision(const std::shared_ptr<domain>& space) const;

  const model* equation_;
  grid mesh_;
  std::vector<domain::faces> sides_;
  stencil how_;
  formulation unknowns_ = formulation::finite_volume;
  bool limited_ = false, explicit_collision_ = false;
  scale epsilon_;
};

}  // namespace apsis
