#pragma once

#include <apsis/core/errors.hpp>
#include <apsis/integrate/mass_matrix.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <span>
#include <utility>
#include <vector>

namespace apsis {

/// Solves (M − γ G'(t, v)) x = r approximately: x ← P⁻¹ r, n numbers each. M is the mass matrix, or 1.
template <class Real>
using shifted_solve = std::function<void(std::span<const Real> r, std::span<Real> x)>;

/// Prepares a shifted_solve for a time t, a state v and a γ > 0, for example by a factorization. Further
/// calls must not change earlier solves.
template <class Real>
using shifted_solves = std::function<shifted_solve<Real>(Real t, std::span<const Real> v, Real gamma)>;

/// Preconditioner of the stages R'(v) ≈ M − aG' − bG'M⁻¹G' of a step for Krylov solvers, from a user's solver
/// of M − γG'. With b = 0 it is P = M − aG'. With b < 0 it is P M⁻¹ P, P = M − γG', γ = √−b. For real spectra
/// of M⁻¹G' and a ≤ 2γ, the eigenvalues of the preconditioned matrix then lie in [1/2, 1].
///
/// A solve serves all stages of a step with the same γ. Steps do not depend on earlier ones.
template <class Real>
class stage_preconditioner {
 public:
  /// Without a preconditioner.
  stage_preconditioner() = default;
  /// Stores the user's function.
  explicit stage_preconditioner(shifted_solves<Real> prepare) : prepare_(std::move(prepare)) {}

  /// Whether there is one.
  explicit operator bool() const { return static_cast<bool>(prepare_); }

  /// Forgets the solves of the last step.
  void begin_step() { kept_.clear(); }

  /// Selects the solve of a stage. Prepares it at (t, v) if the step has none for its γ, or if `again`.
  /// Throws input_error if the function returns no solver.
  void prepare(Real t, std::span<const Real> v, Real a, Real b, bool again) {
    using std::sqrt;
    twice_ = b != Real(0);
    const Real gamma = twice_ ? sqrt(-b) : a;
    auto known =
        std::find_if(kept_.begin(), kept_.end(), [&](const auto& one) { return one.first == gamma; });
    if (known == kept_.end() || again) {
      auto made = prepare_(t, v, gamma);
      if (!made)
        throw input_error(
            "the preconditioner returned no solver (it must solve a system for every step size); return a "
            "function of r and x");
      if (known == kept_.end()) {
        if (kept_.size() == most_kept) kept_.erase(kept_.begin());
        known = kept_.insert(kept_.end(), {gamma, {}});
      }
      known->second = std::move(made);
    }
    now_ = static_cast<std::size_t>(known - kept_.begin());
  }

  /// Sets x ← r divided by the preconditioner that was prepared last.
  void divide(const mass_matrix<Real>* mass, std::span<const Real> r, std::span<Real> x) {
    const shifted_solve<Real>& solve = kept_[now_].second;
    solve(r, x);
    if (!twice_) return;
    between_.assign(x.begin(), x.end());
    if (mass != nullptr) {
      const std::vector<Real> once = between_;
      mass->multiply(once, between_);
    }
    solve(between_, x);
  }

 private:
  static constexpr std::size_t most_kept = 16;  ///< stages of the longest method of the catalogue

  shifted_solves<Real> prepare_;
  std::vector<std::pair<Real, shifted_solve<Real>>> kept_;  ///< by γ
  std::size_t now_ = 0;
  bool twice_ = false;
  std::vector<Real> between_;
};

}  // namespace apsis
