#pragma once

#include <apsis/method/tableau.hpp>
#include <apsis/model/model.hpp>

namespace apsis {

/// Bound on the change of an invariant by rounding, relative to its scale (model::invariant_scales). Derived
/// in docs/strong-stability.md.
struct rounding_bound {
  double of_sums,  ///< contribution of the two sums over the state that are compared
      of_step;     ///< contribution of all stages of a step
  /// Returns the largest change of an invariant in one step that rounding explains.
  double in_one_step() const { return of_sums + of_step; }
};

/// Returns the bound for a step of a method. Let u = 2⁻⁵³, and L the longest chain of additions in a moment
/// ℛu. Stage i carries the error e_i = Σ_j |α_ij| e_j + u (2 + √m_i + c_i (a/u + √L)) Σ_j |α_ij|. Here α_ij
/// are its m_i weights, c_i is the number of collisions that it solves or evaluates, and a is
/// relaxation_model::moment_accuracy(). of_step is e of the last stage.
rounding_bound rounding_of(const shu_osher_form<double>& m, const model& equation);

class run_setup;

/// Returns the bound for a step of the integrator of a run. Its of_step contains the factor
/// error_amplification(), because errors of earlier steps may enter later changes.
rounding_bound rounding_of(const run_setup& setup);

}  // namespace apsis
