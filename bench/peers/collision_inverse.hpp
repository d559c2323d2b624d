#pragma once

#include <apsis/mesh/field.hpp>
#include <apsis/model/model.hpp>

#include <memory>
#include <vector>

namespace apsis::bench::peers {

/// The inverse of I − γJ, where J is the Jacobian of the collision Q(f)/ε at a state, cell by cell.
class collision_inverse {
 public:
  virtual ~collision_inverse() = default;
  /// Prepares solve() for the state f.
  virtual void prepare(const field& f) = 0;
  /// Sets z ← (I − γJ)⁻¹ r.
  virtual void solve(double gamma, const field& r, field& z) const = 0;
};

/// Returns the inverse for BGK. J = (1/ε)(P − I) with P = M′(ω)ℛ, the effect of a perturbation of f on the
/// Maxwellian with its moments. P f has the moments of f, so P² = P, of rank three, and
///   (I − γJ)⁻¹ = (I + λP)/(1 + λ),    λ = γ/ε.
///
/// For cell averages J is the mean over the Gauss points q of (1/ε_q)(P_q − I) D_q, D_q the reconstruction.
/// Here P is that of the average, and 1/ε the mean of the 1/ε_q. The neglected part of P̃ = I + εJ is P̃ − P
/// with ℛ(P̃ − P) = 0. It is not amplified by λ, because (I + λP)(P̃ − P) = P̃ − P. The error of the inverse
/// is therefore of the size of the spatial error, however stiff the cell is. `rates`: 1/ε of every cell. The
/// model must outlive the result.
std::unique_ptr<collision_inverse> make_bgk_inverse(const relaxation_model& equation,
                                                    std::vector<double> rates);

/// Returns the inverse for Broadwell's model on point values. There Q = d q with d = (1, −1, 1) and q = f₀² −
/// f₊f₋. With g = ∇q = (−f₋, 2f₀, −f₊), J = d gᵀ/ε has rank one, gᵀd = −ρ, and
///   (I − γJ)⁻¹ r = r + d gᵀr λ/(1 + λρ),    λ = γ/ε.
std::unique_ptr<collision_inverse> make_broadwell_inverse(std::vector<double> rates);

}  // namespace apsis::bench::peers
