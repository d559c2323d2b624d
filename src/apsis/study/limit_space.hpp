#pragma once

#include <apsis/boundary/domain.hpp>
#include <apsis/config/case.hpp>
#include <apsis/mesh/field.hpp>
#include <apsis/model/model.hpp>
#include <apsis/scheme/reconstruction.hpp>

#include <memory>
#include <vector>

namespace apsis {

/// Space discretisation of a case, face by face, for the limit ε → 0. Independent of the operators of a run
/// (semidiscrete): it uses only reconstruction, quartic, limiter and ghost cells of the space rooms, and
/// moments and equilibrium of the model. Simple and slow.
class limit_space {
 public:
  /// `equation` must outlive this. Throws input_error for an unknown reconstruction, for solid boxes, and
  /// unless the rows beyond every face are rows of cells (periodic, outflow).
  limit_space(const case_config& config, const relaxation_model& equation);

  /// Sets 1/κ of limited fluxes for steps of `share` times the longest, 1 at first: κ =
  /// share Σ_k |v_k|/Δx_k, relative to the fastest component.
  void limit_for_steps(double share);

  /// Cells of the mesh; 1 without space.
  int cells() const { return space_.mesh().size(); }
  /// Whether unknowns are averages of cells in which the equilibrium varies, so that their equilibrium is a
  /// mean over Gauss points; otherwise all operations are pointwise.
  bool averages() const { return averages_; }

  /// ω_i = ℛu_i, [cells][moments].
  field moments(const field& u) const;
  /// E(ω_i), [cells][components]. Throws numerical_error if ω has no equilibrium.
  field equilibria(const field& omega) const;
  /// Π(u)_i = Σ_q w_q E(ℛu(x_q)) with the (limited) quartics u(x) of every component through the averages u;
  /// only if averages(). ℛΠ(u) = ℛu.
  field equilibrium_averages(const field& u) const;
  /// T(u)_i = −Σ_k (φ_{k,i+1/2} − φ_{k,i−1/2})/Δx_k + S(u_i), φ_k the upwind fluxes of all components along
  /// direction k.
  field transport(const field& u) const;

 private:
  struct pencil;
  pencil reconstruct(const field& u, int direction, int segment) const;
  void add_divergence(const field& u, int direction, int segment, field& t) const;
  double face_value(const pencil& p, int face, std::size_t k, bool ahead) const;
  double limiter_coefficient(const pencil& p, int cell, std::size_t k, bool ahead) const;

  const relaxation_model& equation_;
  domain space_;
  std::shared_ptr<const reconstruction> scheme_;
  bool has_space_, averages_ = false, limit_edges_ = false, limit_fluxes_ = false;
  std::vector<double> inverse_cfl_;  ///< 1/κ
};

}  // namespace apsis
