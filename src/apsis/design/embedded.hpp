#pragma once

#include <apsis/method/method.hpp>

#include <optional>
#include <vector>

namespace apsis {

/// Cost of an embedded solution.
enum class embedded_cost {
  nothing,   ///< ũ = r̃ u^n + Σ_j p̃_j u_j; for explicit methods also w̃_j where T(u_j) is available
  one_solve  ///< in addition w̃_j, d̃ and d̃̇: one more stage solve
};

/// Requirements on an embedded solution.
struct embedded_task {
  int order = 0;  ///< order q of ũ; 0 means the highest for which a useful ũ exists
  embedded_cost cost = embedded_cost::one_solve;  ///< admissible cost of ũ
  int parts = 0;          ///< target for u^{n+1} − ũ: θ = 1/parts of the Taylor term of order q + 1; 0 means
                          ///< default_parts(q)
  double negative = 0.6;  ///< weights may be as low as −θ · negative, rounded to three digits, where no
                          ///< convex row is useful
  double least_coverage = 0.15;  ///< lower bound of embedded_attempt::coverage
  double margin = 1.0 / 64;      ///< lower bound of d̃ + |d̃̇| if there is a solve
};

/// Returns N, where a ũ of order q deviates from u^{n+1} by 1/N of the Taylor term: 10, 30 and 15 for q = 1,
/// 2 and above. With these values the error at the end is of the size of the tolerance (docs/design.md).
inline int default_parts(int q) {
  return q == 1 ? 10 : q == 2 ? 30 : 15;
}

/// Result of the search at one order.
struct embedded_attempt {
  int order = 0;       ///< order q
  bool convex = true;  ///< whether all weights are required to be ≥ 0
  double residual =
      0.0;  ///< largest |residual| at the closest point with x ≥ 0; rounding error if there is a solution
  /// ‖t − E x‖/(θ ‖t‖), the smaller of its values over the trees of T alone and of Q alone. This part of the
  /// estimate is left in the limit ε → 0, and for relaxation without transport. 0 for u^{n+1} itself.
  double coverage = 0.0;
};

/// Result of search_embedded().
struct embedded_search {
  std::optional<embedded_row> found;       ///< with coefficients of 45 digits, or exact rationals where
                                           ///< they are simple
  std::vector<embedded_attempt> attempts;  ///< in descending order q, convex rows first
};

/// Searches for an embedded solution of order q < p of a method of order p that is suitable for error
/// estimation, convex if possible.
///
/// Its unknowns x = (p̃_j, w̃_j, r̃, d̃, −d̃̇) ≥ 0 satisfy linear equations. The order conditions at the new row
/// are φ̃(τ) = 1/γ(τ) for |τ| ≤ q. All factors of the products under the root of a tree of order ≤ q + 1 are
/// therefore known there. Let φ_j be the stage vectors of the method, g_j and h_j the products under the
/// root, and g̃ and h̃ the same products of 1/γ. Then
///   root T:  φ̃ = Σ_j (p̃_j + w̃_j) φ_j + (1/r) Σ_j w̃_j g_j
///   root Q:  φ̃ = Σ_j (p̃_j + w̃_j) φ_j + d̃ g̃ + d̃̇ h̃.
/// For |τ| ≤ q these are equations A x = b, together with r̃ + Σ_j (p̃_j + w̃_j) = 1. For |τ| = q + 1 they
/// define E x, and u^{n+1} − ũ = Δt^{q+1} Σ_τ (1/γ(τ) − (E x)_τ) F(τ)/σ(τ) + …. If E x = (1 − θ) t with t_τ =
/// 1/γ(τ), the difference is θ times the Taylor term. No elementary differential then has more weight than
/// another. Therefore x is
///   arg min Σ_k ‖E_k x − (1 − θ) t_k‖²/‖t_k‖²   over A x = b, x ≥ 0,   for the better sign of θ,
/// where k stands for the trees of T alone, of Q alone, and all others. nonnegative_least_squares() solves
/// this convex problem in 60 digits. The last stage, u^{n+1}, and its T have weight 0, because mixing with
/// u^{n+1} only reduces θ. w̃_j is nonzero only where T(u_j) is evaluated anyway.
///
/// If the method claims exact O(ε) terms for ε ≪ Δt, a ũ with a stage solve has the same O(ε) term as
/// u^{n+1}: Σ_j w̃_j/r = d̃ and d̃̇ = 0 ((N2) of docs/plateaus.md, also linear). Otherwise u^{n+1} − ũ would
/// stall at a multiple of ε.
///
/// The row of u^{n+1} satisfies all equations but estimates nothing. If no other convex solution sufficiently
/// covers the trees of each colour, weights down to −θ · negative are admitted for q ≥ 2 and kind imex. The
/// signs d̃ ≥ 0 ≥ d̃̇ remain. An order q without a solution of either kind is skipped. u^{n+1} does not depend
/// on ũ. The bound only keeps ũ itself admissible where stages differ by less than that. Throws input_error
/// for methods with a nondiagonal D, with an update, or of order 1, and for orders not below p. Throws it
/// also for an explicit method if the cost allows a solve.
embedded_search search_embedded(const method& m, const embedded_task& task);

}  // namespace apsis
