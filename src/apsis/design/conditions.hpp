#pragma once

#include <apsis/design/stage_series.hpp>
#include <apsis/method/method.hpp>

#include <string>
#include <vector>

namespace apsis {

/// A polynomial equation Σ_t a_t Π_f y_f[stage_t] = target/divisor in stage vectors y. A list of nodes
/// defines these vectors.
struct design_condition {
  /// A term a Π_f y_f[stage].
  struct term {
    double factor;           ///< a
    std::vector<int> nodes;  ///< indices of the y_f in the list of nodes; repetitions are allowed
    std::size_t stage;       ///< counted from 0
  };
  std::string name;         ///< for reports: "F[G,G]" for a tree, "c = c_hat at stage 2"
  std::vector<term> terms;  ///< their sum is the left-hand side
  double target = 0.0,      ///< right-hand side times `divisor`
      divisor = 1.0;        ///< γ(τ) for a tree, so that 1/γ(τ) is exact to the precision of the evaluation
};

/// Equations and the stage vectors that enter them.
struct condition_list {
  std::vector<series_node> nodes;            ///< sorted such that the arguments of a node precede it
  std::vector<design_condition> conditions;  ///< with terms that refer to `nodes`
};

/// Conditions on the O(ε) terms for ε ≪ Δt (docs/plateaus.md).
enum class regime_demand {
  none,  ///< no condition
  slow,  ///< flux = last = 1: (N1) and (N2)
  all    ///< in addition layer = 1: (N3)
};

/// Returns the order conditions of the paper's class in a form that is regular at its solutions.
///
/// With transport, order ≥ 3 implies Σ b̂_i (c_i − ĉ_i)² = 0 with b̂ ≥ 0, so that c = ĉ at each stage in
/// `transport`. These equations are imposed. Of trees that differ only in leaves under a node T, one is kept
/// (15 of 20 conditions at order 3, 49 of 72 at order 4). Without transport, order ≥ 5 implies Σ b_i δ_i² = 0
/// with δ = Ac + ȧ − c²/2, so that δ = 0 at each stage with d > 0, those in `relaxation`. Both lists have one
/// entry per stage. The proofs are in docs/design.md.
condition_list order_equations(method_kind kind, int order, std::size_t stages,
                               const std::vector<char>& transport, const std::vector<char>& relaxation,
                               int steps = 1);

/// Adds the conditions among (N1) to (N3) that `demand` requires.
void add_regime_equations(condition_list& list, regime_demand demand, std::size_t stages);

/// Returns the conditions of exactly this order. Their residuals form the error constant.
condition_list error_terms(method_kind kind, int order, std::size_t stages);

/// Returns terms whose residuals measure the error of the O(ε) term where ε ~ Δt (docs/plateaus.md, the
/// band). With z = CΔt/ε, their 2-norm is that of (flux(z) − 1)/z · (1 − R(−z))/(1 − e^{−z}) over log₁₀ z,
/// 0.1 ≤ z ≤ 300.
condition_list band_terms(std::size_t stages, int steps = 1);

/// Returns terms whose residuals measure the other errors of size ε where ε ~ Δt (docs/plateaus.md, the
/// band):
/// - in the initial layer: b̂·λ(z) − (1 − R(−z))/z, only for one step (starters integrate the layer);
/// - of the deviation from equilibrium at the end of a step: (last(z) − 1)/z · (1 − R(−z))/(1 − e^{−z}).
/// Their 2-norm is that over log₁₀ z, 0.1 ≤ z ≤ 300.
condition_list layer_terms(std::size_t stages, int steps = 1);

/// Returns (|R(ζ)|² − 1)/min(1, |ζ|)⁴ on the ray at angle `degrees` from the negative axis, for 24 radii per
/// decade, 0.1 ≤ |ζ| ≤ 300. A(α)-stability of the implicit part requires values ≤ 0.
condition_list stability_limits(double degrees, std::size_t stages);

/// Values and gradients of a list of conditions at a given set of coefficients.
template <class Real>
class condition_sweep {
 public:
  /// `slow[i]` marks stages with ḋ_i = 0 by design, see stage_series.
  condition_sweep(const condition_list& list, const std::vector<char>& slow, int steps = 1)
      : series_(list.nodes, slow, steps), conditions_(list.conditions) {}

  /// Number of conditions.
  std::size_t size() const { return conditions_.size(); }
  /// Computes the stage vectors of a method, on which the other functions depend.
  void evaluate(const shu_osher_form<Real>& m) { series_.evaluate(m); }

  /// Returns the left-hand side minus target of condition k.
  Real residual(std::size_t k) const {
    Real sum = Real(-conditions_[k].target) / Real(conditions_[k].divisor);
    for (const auto& term : conditions_[k].terms) {
      Real product(term.factor);
      for (const int node : term.nodes) product *= series_.value(node, term.stage);
      sum += product;
    }
    return sum;
  }

  /// Adds weight times condition k to the sum that reverse() differentiates.
  void seed(std::size_t k, const Real& weight) {
    for (const auto& term : conditions_[k].terms)
      for (std::size_t f = 0; f < term.nodes.size(); ++f) {
        Real others = weight * Real(term.factor);
        for (std::size_t l = 0; l < term.nodes.size(); ++l)
          if (l != f) others *= series_.value(term.nodes[l], term.stage);
        series_.seed(term.nodes[f], term.stage, others);
      }
  }

  /// Adds the gradient of the seeded sum to `out` and clears the seeds.
  void reverse(shu_osher_form<Real>& out) { series_.reverse(out); }

 private:
  stage_series<Real> series_;
  std::vector<design_condition> conditions_;
};

}  // namespace apsis
