#pragma once

#include <apsis/model/model.hpp>
#include <apsis/phase/field.hpp>

#include <span>
#include <vector>

#include <sundials/sundials_linearsolver.h>

namespace apsis::bench::peers {

/// The inverse of I − γJ for J = (1/ε)(P − I), P = M′(ω)ℛ: what a perturbation of f does to the Maxwellian
/// with its moments. Moments of P f are those of f, so P² = P and
///   (I − γJ)⁻¹ = (I + λP)/(1 + λ),    λ = γ/ε,
/// cell by cell: P has rank three.
///
/// For cell averages J is the mean over the Gauss points q of (1/ε_q)(P_q − I) D_q, D_q the
/// reconstruction. Here P is that of the average, and 1/ε the mean of the 1/ε_q. What is neglected, P̃ − P
/// with ℛ(P̃ − P) = 0, is not amplified by λ: (I + λP)(P̃ − P) = P̃ − P. So the error of the inverse is of the
/// size of the space error, however stiff the cell.
class projection {
 public:
  /// `rates`: the 1/ε of every cell. Velocities and model must outlive it.
  projection(const relaxation_model& equation, std::vector<double> rates);

  /// P of the state f.
  void prepare(const field& f);
  /// z ← (I + λP)/(1 + λ) r.
  void solve(double gamma, const field& r, field& z) const;

 private:
  struct fluid {
    double rho, u, T;
  };
  const relaxation_model& equation_;
  std::vector<double> rates_;
  std::vector<fluid> states_;
  field maxwellians_;
};

/// A solver of linear systems for SUNDIALS that takes the preconditioner for the inverse: no Krylov
/// iterations, no products with the Jacobian. Newton's method becomes a modified one with an approximate
/// Jacobian.
SUNLinearSolver make_preconditioner_solver(SUNContext context);

}  // namespace apsis::bench::peers
