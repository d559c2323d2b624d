#pragma once

#include <apsis/method/method.hpp>

#include <optional>

namespace apsis {

/// What an embedded solution may cost.
enum class embedded_cost {
  nothing,   ///< ũ = r̃ u^n + Σ_j p̃_j u_j, a convex combination of stages
  one_solve  ///< one more row of the Shu–Osher form: T of stages that is known anyway, and one solve of Q
};

/// A solution of lower order beside u^{n+1}, for an estimate of the error: the last row of `extended`.
struct embedded_solution {
  shu_osher_form<double> extended;  ///< the method with one more row
  double error = 0.0;               ///< 2-norm of the residuals of order p of ũ: the size of the estimate
};

/// What was found, or how near it came.
struct embedded_search {
  std::optional<embedded_solution> found;
  double nearest = 0.0;  ///< smallest largest |equation|
};

/// An embedded solution of order p − 1 of a method of order p, without weight on u^{n+1} itself, with the
/// signs of the paper's theorems, so that it keeps what the method keeps: of those, the one with the smallest
/// residuals of order p and few coefficients.
///
/// Its equations are linear, because c̃ = 1 and the like are among them: Σ_j p̃_j φ_j(τ) + … = 1/γ(τ). So a
/// search that ends away from zero has shown that there is none: the nearest point of a convex set is the
/// same from everywhere. In particular there is none of cost nothing if c_i < 1 at all earlier stages.
embedded_search find_embedded(const shu_osher_form<double>& m, method_kind kind, int order,
                              embedded_cost cost);

}  // namespace apsis
