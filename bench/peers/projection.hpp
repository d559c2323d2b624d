#pragma once

#include <apsis/model/model.hpp>
#include <apsis/phase/field.hpp>

#include <span>
#include <vector>

#include <sundials/sundials_linearsolver.h>

namespace apsis::bench::peers {

/// Inverse of I − γJ for J = (1/ε)(P − I), P = M′(ω)ℛ, the effect of a perturbation of f on the Maxwellian
/// with its moments. P f has the moments of f, so P² = P and
///   (I − γJ)⁻¹ = (I + λP)/(1 + λ),    λ = γ/ε,
/// cell by cell: P has rank three.
///
/// For cell averages J is the mean over the Gauss points q of (1/ε_q)(P_q − I) D_q, D_q the reconstruction.
/// Here P is that of the average, and 1/ε the mean of the 1/ε_q. The neglected part P̃ − P with ℛ(P̃ − P) = 0
/// is not amplified by λ: (I + λP)(P̃ − P) = P̃ − P. Hence the error of the inverse is of the size of the
/// spatial error, however stiff the cell is.
class projection {
 public:
  /// `rates`: 1/ε of every cell. The model must outlive this object.
  projection(const relaxation_model& equation, std::vector<double> rates);

  /// Computes P of the state f.
  void prepare(const field& f);
  /// Sets z ← (I + λP)/(1 + λ) r.
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

/// Makes a linear solver for SUNDIALS that uses the preconditioner as the inverse, without Krylov iterations
/// and Jacobian products: a modified Newton method with an approximate Jacobian.
SUNLinearSolver make_preconditioner_solver(SUNContext context);

}  // namespace apsis::bench::peers
