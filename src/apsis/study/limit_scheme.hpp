#pragma once

#include <apsis/config/case.hpp>

#include <memory>
#include <span>
#include <vector>

namespace apsis {

/// The limit ε → 0 of an IMEX method on a discretised relaxation model u_t = T(u) + C(E − u)/ε at fixed Δt
/// and mesh. See the proof of the AP property in the paper. The scheme is independent of the operators and
/// the stepper of a run, for comparison with them.
///
/// With point values (also first order, and no space), the unknowns are the moments ω. They follow the
/// explicit method Â for the limit system with flux vector splitting,
///     ω_i = ω^n + Δt Σ_{j<i} â_ij ℛT(E(ω_j)),   ω^{n+1} = ω_s.
/// With cell averages, a stage relaxes at the Gauss points of the quartics through its explicit part v_i. The
/// state is then the average u_i = Π(v_i) of equilibria in each cell (limit_space::equilibrium_averages):
///     v_i = u^n + Δt Σ_{j<i} â_ij T(u_j) + Σ_{j<i} κ_ij (u_j − v_j)
/// Here κ_ij = ȧ_ij/ȧ_jj, or a_ij/a_jj if ȧ_jj = 0. Because ℛ(u_j − v_j) = 0, the averages of ω follow
/// Â here too. The κ-terms affect only the distribution of ω inside the cells. Stages without implicit
/// part are not relaxed.
class limit_scheme {
 public:
  /// Throws input_error unless the model is a relaxation model and the method is IMEX.
  explicit limit_scheme(const case_config& config);
  ~limit_scheme();
  limit_scheme(limit_scheme&&) noexcept;             ///< leaves the source empty
  limit_scheme& operator=(limit_scheme&&) noexcept;  ///< leaves the source empty

  /// Sets the share of the longest step for which the positivity limiter is set, initially 1. That of a run
  /// is simulation::limiter_share().
  void limit_for_steps(double share);
  /// Starts from the state u, [cells][components]; it need not be an equilibrium.
  void start(std::span<const double> u);
  /// Performs one step of length dt. Throws numerical_error if a stage has no equilibrium.
  void step(double dt);

  /// Returns ω of the current state: averages or point values, [cells][moments].
  std::vector<double> moments() const;
  /// Returns the equilibrium of the current state: E(ω), or the averages Π, [cells][components].
  std::vector<double> equilibrium() const;

  /// Returns ω, [cells][moments], of any state u, [cells][components].
  std::vector<double> moments_of(std::span<const double> u) const;
  /// Returns the equilibrium of any state u: E(ℛu), or the averages Π(u), [cells][components].
  std::vector<double> equilibrium_of(std::span<const double> u) const;
  /// Returns whether the method relaxes its first stage (type A) and thus projects the
  /// initial data by itself.
  bool relaxes_first_stage() const;

 private:
  struct impl;
  std::unique_ptr<impl> impl_;
};

}  // namespace apsis
