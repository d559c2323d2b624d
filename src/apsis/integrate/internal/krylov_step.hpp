#pragma once

#include <apsis/core/errors.hpp>
#include <apsis/integrate/internal/newton_step.hpp>
#include <apsis/integrate/mass_matrix.hpp>

#include <limits>
#include <utility>

#include <Eigen/Dense>
#include <Eigen/Sparse>
#include <fmt/format.h>
#include <unsupported/Eigen/IterativeSolvers>

namespace apsis::detail {

/// R'(v) P⁻¹ as a matrix-free operator for the iterative solvers of Eigen. P stands on the right, so that
/// GMRES reduces the residual of Newton's equation.
template <class Real>
class newton_operator;

}  // namespace apsis::detail

namespace Eigen::internal {
template <class Real>
struct traits<apsis::detail::newton_operator<Real>> : traits<SparseMatrix<Real>> {};
}  // namespace Eigen::internal

namespace apsis::detail {

template <class Real>
class newton_operator : public Eigen::EigenBase<newton_operator<Real>> {
 public:
  using Scalar = Real;
  using RealScalar = Real;
  using StorageIndex = int;
  enum { ColsAtCompileTime = Eigen::Dynamic, MaxColsAtCompileTime = Eigen::Dynamic, IsRowMajor = false };

  newton_operator(stage_equation<Real>& equation, const column<Real>& v) : equation_(equation), v_(v) {}
  Eigen::Index rows() const { return v_.size(); }
  Eigen::Index cols() const { return v_.size(); }

  template <class Rhs>
  Eigen::Product<newton_operator, Rhs, Eigen::AliasFreeProduct> operator*(
      const Eigen::MatrixBase<Rhs>& x) const {
    return {*this, x.derived()};
  }

  /// Returns R'(v) P⁻¹ x.
  column<Real> apply(const column<Real>& x) const {
    const column<Real> divided = precondition(x);
    column<Real> y(x.size()), z(x.size());
    equation_.differential(as_span(v_), as_span(divided), as_span(y), as_span(z));
    return masses(equation_, divided) + y + z;
  }
  /// Returns P⁻¹ x.
  column<Real> precondition(const column<Real>& x) const {
    if (!equation_.has_preconditioner()) return x;
    column<Real> divided = column<Real>::Zero(x.size());
    equation_.precondition(as_span(x), as_span(divided));
    if (x.allFinite() && !divided.allFinite())
      throw numerical_error(
          "the preconditioner returned a number that is not finite (for a finite right-hand side); check it, "
          "or reduce the time step");
    return divided;
  }

 private:
  stage_equation<Real>& equation_;
  const column<Real>& v_;
};

}  // namespace apsis::detail

namespace Eigen::internal {
template <class Real, class Rhs>
struct generic_product_impl<apsis::detail::newton_operator<Real>, Rhs, SparseShape, DenseShape, GemvProduct>
    : generic_product_impl_base<apsis::detail::newton_operator<Real>, Rhs,
                                generic_product_impl<apsis::detail::newton_operator<Real>, Rhs>> {
  using Scalar = Real;
  template <class Dest>
  // NOLINTNEXTLINE(readability-identifier-naming): Eigen looks for this name
  static void scaleAndAddTo(Dest& dest, const apsis::detail::newton_operator<Real>& lhs, const Rhs& rhs,
                            const Scalar& alpha) {
    dest.noalias() += alpha * lhs.apply(rhs);
  }
};
}  // namespace Eigen::internal

namespace apsis::detail {

/// Solves R'(v) Δ = −r by GMRES to a few digits. Returns whether the residual of the system decreased by a
/// factor of 10. Throws numerical_error if R'(v) is singular.
template <class Real>
bool solve_by_gmres(stage_equation<Real>& equation, const column<Real>& v, const column<Real>& r,
                    column<Real>& step, int iteration) {
  const newton_operator<Real> jacobian(equation, v);
  Eigen::GMRES<newton_operator<Real>, Eigen::IdentityPreconditioner> gmres(jacobian);
  gmres.set_restart(60);
  gmres.setMaxIterations(600);
  gmres.setTolerance(Real(1e-6));
  // Scale the right-hand side to size 1: GMRES squares it, and small residuals would underflow.
  const Real size = largest<Real>(r);
  step = jacobian.precondition(gmres.solve(-r / size) * size);
  column<Real> y(v.size()), z(v.size());
  equation.differential(as_span<Real>(v), as_span<Real>(std::as_const(step)), as_span(y), as_span(z));
  const column<Real> moved = masses(equation, step);
  const Real applied = largest<Real>(moved + y + z);
  const Real terms = largest<Real>(moved.cwiseAbs() + y.cwiseAbs() + z.cwiseAbs());
  if (applied < singular_below<Real> * terms) fail_singular(iteration, static_cast<double>(applied / terms));
  return step.allFinite() && largest<Real>(moved + y + z + r) <= Real(0.1) * size;
}

/// Solves R'(v) Δ = −r by GMRES, to a few digits only, because Newton's method repeats it. A preconditioner
/// of another v is renewed if it does not suffice.
template <class Real>
newton_step<Real> krylov_step(stage_equation<Real>& equation, const column<Real>& v, const column<Real>& r,
                              int iteration) {
  column<Real> step;
  bool solved = false;
  if (equation.has_preconditioner()) {
    for (const bool again : {false, true}) {
      if (solved) break;
      equation.prepare_preconditioner(as_span<Real>(v), again);
      solved = solve_by_gmres(equation, v, r, step, iteration);
    }
  } else {
    solved = solve_by_gmres(equation, v, r, step, iteration);
  }
  if (!solved)
    throw numerical_error(fmt::format(
        "GMRES does not solve the linear system of Newton iteration {} (nearly singular, or too stiff {}); "
        "reduce the "
        "time step, or {}",
        iteration, equation.has_preconditioner() ? "for its preconditioner" : "without a preconditioner",
        equation.has_preconditioner() ? "improve the preconditioner"
                                      : "use with_preconditioner or linear_solver::dense"));
  column<Real> y(v.size()), z(v.size());
  equation.differential(as_span<Real>(v), as_span<Real>(v), as_span(y), as_span(z));
  const Real noise = std::numeric_limits<Real>::epsilon() *
                     largest<Real>(masses(equation, v).cwiseAbs() + y.cwiseAbs() + z.cwiseAbs());
  return {step, noise, Real(0), {}};
}

}  // namespace apsis::detail
