#pragma once

#include <apsis/boundary/domain.hpp>
#include <apsis/integrate/problem.hpp>
#include <apsis/model/model.hpp>
#include <apsis/semidiscrete/block_sweep.hpp>
#include <apsis/semidiscrete/cell_unknown.hpp>
#include <apsis/semidiscrete/cut_transport.hpp>
#include <apsis/semidiscrete/face_fluxes.hpp>
#include <apsis/semidiscrete/force.hpp>
#include <apsis/semidiscrete/ring_rotation.hpp>
#include <apsis/semidiscrete/source.hpp>
#include <apsis/semidiscrete/transport.hpp>

#include <memory>
#include <span>
#include <vector>

namespace apsis {

/// Transport by upwind fluxes of reconstructed edge values. For constant speeds the operator is the same for
/// cell averages (finite volumes) and point values (finite differences). With the positivity limiter and β ≤
/// α Δt_FE, results are nonnegative, even in floating-point arithmetic.
class upwind_transport final : public transport {
 public:
  /// `equation` and `unknown` must outlive the operator. Without space `edges` is ignored.
  upwind_transport(const model& equation, std::shared_ptr<domain> space, limited_reconstruction edges,
                   const cell_unknown& unknown);
  ~upwind_transport() override;

  /// Calls `then` if cells are complete box by box: in many boxes, without force, rotation and source.
  bool add_transport(double t, const field& u, std::span<const target<field, double>> targets,
                     const cells_job& then = {}) const override;
  void combine(std::span<const linear_term<field, double>> terms, field& sum) const override;
  std::span<const double> budget_rates() const override { return faces_->rates(); }
  std::vector<double> observe_surfaces(double t, const field& u) const override;

  void set_force(acceleration of) override;
  void set_rotation(int radial) override;
  void set_source(source_rate rate) override;

  /// 1/Δt_FE = max_j Σ_k |v_jk|/Δx_k / κ + force::rate() with κ = limited_reconstruction::kappa(), at most
  /// cut_cells::cfl_number with bodies. In axisymmetric flow it is max_j ring_rotation::rates_with() / κ.
  double forward_euler_step() const override;
  void limit_for_steps(double share) override;
  void limit_for_steady_states(double collisions) override;
  double growth_of_source(double t, const field& u) const override;
  bool source_depends_on_state() const override { return source_ && source_->depends_on_state(); }

 private:
  void account_inside() const;
  void add_source(const field& u, std::span<const target<field, double>> targets) const;
  void add_weighted(const field& u, std::span<const target<field, double>> targets,
                    const cells_job& then) const;
  bool sweep(double t, const field& u, std::span<const target<field, double>> targets,
             const cells_job& then) const;
  struct sweep_plan;
  void sweep_boxes(double t, const field& u, std::span<const target<field, double>> targets,
                   const sweep_plan& plan, const std::vector<int>& numbers, const cells_job& then) const;
  block_sweep& sweep_of_box(const block_sweep::context& all, const field& u, const cell_box& box) const;
  void complete_box(double t, const field& u, std::span<const target<field, double>> targets,
                    const cell_box& box) const;
  void finish_box(const cell_box& box, const cells_job& then) const;
  template <class Body>
  void for_segments(int direction, const cell_box& box, const Body& body) const;

  const grid& mesh() const { return space_->mesh(); }

  const model& equation_;
  std::shared_ptr<domain> space_;
  limited_reconstruction edges_;
  const cell_unknown& unknown_;
  double share_ = 1.0;  ///< bound for the limiter, in units of Δt_FE
  double kappa_ = 1.0;
  double fastest_ = 0.0;  ///< largest rate of transport and rotation of a component
  std::unique_ptr<face_fluxes> faces_;
  std::unique_ptr<cut_transport> cut_;       ///< null without bodies
  std::unique_ptr<force> force_;             ///< null without a force
  std::unique_ptr<ring_rotation> rotation_;  ///< null without rotation
  std::unique_ptr<source> source_;           ///< null without a source
  struct scratch;
  std::vector<line_speeds> speeds_;   ///< speeds along each direction
  std::unique_ptr<scratch> scratch_;  ///< scratch memory of loops; one loop at a time
};

}  // namespace apsis
