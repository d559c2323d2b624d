#pragma once

#include <apsis/boundary/domain.hpp>
#include <apsis/integrate/problem.hpp>
#include <apsis/model/model.hpp>
#include <apsis/semidiscrete/block_sweep.hpp>
#include <apsis/semidiscrete/face_fluxes.hpp>
#include <apsis/semidiscrete/force.hpp>
#include <apsis/semidiscrete/source.hpp>
#include <apsis/semidiscrete/sweep.hpp>

#include <memory>
#include <span>
#include <vector>

namespace apsis {

/// Factor slightly below 1 of every forward Euler step: at the exact limit the rounding of α u + β T(u), a
/// few units in the last place, could make a value negative.
inline constexpr double rounding_allowance = 1.0 - 1e-14;

/// T(u) = −Σ_k ∂_xk(v_k u) − a·∇_v u + S(u) with upwind fluxes of reconstructed edge values. For constant
/// speeds the operator is the same for cell averages (finite volume) and point values (finite difference).
class transport {
 public:
  /// `equation` must outlive the operator. Without space `how` is ignored.
  transport(const model& equation, std::shared_ptr<domain> space, spatial_discretization discretization);
  ~transport();
  transport(transport&&) noexcept;  ///< leaves the source empty

  /// For each target: acc ← (fresh ? 0 : acc) + α u + β T(t, u), with one evaluation of T, or none if every β
  /// is 0. With the positivity limiter and β max_j Σ_k |v_jk|/Δx_k ≤ α/12 no result is negative, also in
  /// floating point. `then` is called with completed cells of all targets while they are in cache, and true
  /// is returned; where fusion does not pay (mesh, number of threads) it is not called, and false is
  /// returned.
  bool add_transport(double t, const field& u, std::span<const target<field, double>> targets,
                     const cells_job& then = {}) const;

  /// sum ← Σ_k α_k u_k, one term at least, added in their order; `sum` may be the state of the first term.
  void combine(std::span<const linear_term<field, double>> terms, field& sum) const;

  /// Returns what u has received per unit of time in the last evaluation of T: the rates of a
  /// boundary_budget. Empty without space.
  std::span<const double> budget_rates() const { return faces_->rates(); }

  /// Returns the densities of the invariants at every surface (face_fluxes::densities()) of the state u at
  /// time t; nothing without space.
  std::vector<double> densities_at_surfaces(double t, const field& u) const;

  /// Adds a force. Throws input_error as force does.
  void set_force(acceleration of);
  /// Adds a source.
  void set_source(source_rate rate, formulation unknowns);

  /// Δt_FE = κ / (max_j Σ_k |v_jk|/Δx_k + Σ_k max|a_k|/Δv): κ = 1/12 with the positivity limiter (Zhang & Shu
  /// 2010), else 1, which for first-order upwind keeps positivity, total variation and entropy. +infinity
  /// without space.
  double forward_euler_step() const;
  /// Returns source::growth() of this process; 0 without a source that depends on u.
  double growth_of_source(double t, const field& u) const;
  /// Whether there is a source that depends on u.
  bool source_depends_on_state() const { return source_ && source_->depends_on_state(); }

 private:
  void add_source(const field& u, std::span<const target<field, double>> targets) const;
  void add_weighted(const field& u, std::span<const target<field, double>> targets,
                    const cells_job& then) const;
  bool sweep(double t, const field& u, std::span<const target<field, double>> targets,
             const cells_job& then) const;
  struct sweep_plan;
  void sweep_boxes(double t, const field& u, std::span<const target<field, double>> targets,
                   const sweep_plan& plan, const std::vector<int>& numbers, const cells_job& then) const;
  void sweep_box(const field& u, std::span<const target<field, double>> targets, const cell_box& box,
                 int first, int last) const;
  void complete_box(double t, std::span<const target<field, double>> targets, const cell_box& box) const;
  void finish_box(const cell_box& box, const cells_job& then) const;
  template <class Body>
  void for_segments(int direction, const cell_box& box, const Body& body) const;

  const grid& mesh() const { return space_->mesh(); }

  const model& equation_;
  std::shared_ptr<domain> space_;
  spatial_discretization discretization_;
  std::unique_ptr<face_fluxes> faces_;
  std::unique_ptr<force> force_;    ///< null without
  std::unique_ptr<source> source_;  ///< null without
  struct scratch;
  std::vector<line_speeds> speeds_;   ///< of each direction
  std::unique_ptr<scratch> scratch_;  ///< scratch memory of loops; one loop at a time
};

}  // namespace apsis
