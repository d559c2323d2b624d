#pragma once

#include <apsis/boundary/domain.hpp>
#include <apsis/config/case.hpp>
#include <apsis/mesh/field.hpp>
#include <apsis/model/model.hpp>
#include <apsis/scheme/reconstruction.hpp>

#include <memory>
#include <vector>

namespace apsis {

/// Space discretisation of a case, face by face, for the limit ε → 0. It is independent of the operators of a
/// run (semidiscrete). It uses only reconstruction, quartic, limiter and ghost cells of the space rooms, and
/// moments and equilibrium of the model. It is simple and slow.
class limit_space {
 public:
  /// `equation` must outlive this object. Throws input_error for an unknown reconstruction, and for solid
  /// boxes or bodies. Also throws it unless the rows beyond every face are rows of cells (periodic, outflow).
  limit_space(const case_config& config, const relaxation_model& equation);

  /// Sets 1/κ of limited fluxes for steps of `share` times the longest; `share` is initially 1. κ = share Σ_k
  /// |v_k|/Δx_k, relative to the fastest component.
  void limit_for_steps(double share);

  /// Returns the number of cells of the mesh; 1 without space.
  int cells() const { return space_.mesh().size(); }
  /// Returns whether unknowns are averages of cells in which the equilibrium varies. Their equilibrium is
  /// then a mean over Gauss points; otherwise all operations are pointwise.
  bool averages() const { return averages_; }

  /// Returns ω_i = ℛu_i, [cells][moments].
  field moments(const field& u) const;
  /// Returns E(ω_i), [cells][components]. Throws numerical_error if ω has no equilibrium.
  field equilibria(const field& omega) const;
  /// Returns Π(u)_i = Σ_q w_q E(ℛu(x_q)) with the (limited) quartics u(x) of every component through the
  /// averages u. Requires averages(). ℛΠ(u) = ℛu.
  field equilibrium_averages(const field& u) const;
  /// Returns T(u)_i = −Σ_k (φ_{k,i+1/2} − φ_{k,i−1/2})/Δx_k + S(u_i). φ_k are the upwind fluxes of all
  /// components along direction k.
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
