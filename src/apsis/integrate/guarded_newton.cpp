// GCC warns about the deliberately undefined register of its AVX-512 intrinsics, which Eigen uses.
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif

#include <apsis/integrate/guarded_newton.hpp>

#include "internal/krylov_step.hpp"
#include "internal/newton_step.hpp"

#include <apsis/core/errors.hpp>
#include <apsis/integrate/mass_matrix.hpp>
#include <apsis/integrate/unsquared_newton.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

#include <Eigen/Dense>
#include <fmt/format.h>

namespace apsis {
namespace {

using detail::advice;
using detail::as_span;
using detail::column;
using detail::fail_singular;
using detail::krylov_step;
using detail::largest;
using detail::newton_step;
using detail::singular_below;

template <class Real>
using square = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;

/// Returns the largest stiffness of a stage that is solved for v alone. Rounding errors of stiff directions,
/// times the stiffness, reach the others: at most 2e-10 with Ġ in double precision. Without Ġ this solver and
/// unsquared_newton() lose the same digits, but only the latter estimates the loss.
template <class Real>
Real stiffest(const stage_equation<Real>& equation) {
  return equation.terms().b != Real(0) ? Real(1e6) : Real(1e8);
}

/// Returns max_ik √|m_ik m_ki|, which does not depend on the units of the unknowns.
template <class Real>
Real stiffness_of(const square<Real>& m) {
  return std::sqrt(m.cwiseProduct(m.transpose()).maxCoeff());
}

/// Solves R'(v) Δ = −r by LU, without a mass matrix. Rows and columns are scaled by the terms of R' before
/// they cancel, so that the test for singularity measures cancellation and neither stiffness nor units.
template <class Real>
newton_step<Real> dense_step(stage_equation<Real>& equation, const column<Real>& v, const column<Real>& r,
                             int iteration) {
  const Eigen::Index n = v.size();
  square<Real> m(n, n), terms(n, n);
  column<Real> x = column<Real>::Zero(n), y(n), z(n);
  for (Eigen::Index k = 0; k < n; ++k) {
    x[k] = Real(1);
    equation.differential(as_span<Real>(v), as_span<Real>(std::as_const(x)), as_span(y), as_span(z));
    m.col(k) = x + y + z;
    terms.col(k) = x + y.cwiseAbs() + z.cwiseAbs();
    x[k] = Real(0);
  }
  if (!m.allFinite())
    throw numerical_error(
        fmt::format("the derivative of the stage equation is not finite (Newton iteration {}); check that G "
                    "is differentiable on the admissible set",
                    iteration));
  const column<Real> rows = terms.rowwise().maxCoeff().cwiseInverse();
  const column<Real> cols = (rows.asDiagonal() * terms).colwise().maxCoeff().cwiseInverse().transpose();
  const square<Real> scaled = rows.asDiagonal() * m * cols.asDiagonal();
  const Real stiffness = n > 1 ? stiffness_of<Real>(terms) : Real(0);
  if (stiffness > stiffest(equation)) return {x, Real(0), stiffness, {}};
  const Real norm = scaled.cwiseAbs().colwise().sum().maxCoeff();
  const Eigen::PartialPivLU<square<Real>> lu(scaled);
  const Real smallest = norm > Real(0) ? lu.rcond() * norm : Real(0);
  if (!(smallest >= singular_below<Real>)) fail_singular(iteration, static_cast<double>(smallest));
  const Real noise = std::numeric_limits<Real>::epsilon() * largest<Real>(terms * v.cwiseAbs());
  const auto correct = [lu, rows, cols](const column<Real>& residual) -> column<Real> {
    return -(cols.asDiagonal() * lu.solve(rows.asDiagonal() * residual));
  };
  return {correct(r), noise, stiffness, correct};
}

template <class Real>
class newton {
 public:
  newton(stage_equation<Real>& equation, std::span<Real> start, const newton_options& options)
      : equation_(equation),
        options_(options),
        v_(Eigen::Map<column<Real>>(start.data(), static_cast<Eigen::Index>(start.size()))),
        r_(v_.size()),
        trial_(v_.size()),
        trial_r_(v_.size()) {}

  newton_report solve(std::span<Real> out) {
    // The measure of stiffness of dense_step() compares terms with an entry 1 of every row.
    if (equation_.mass() != nullptr && is_dense()) return unsquared_newton<Real>(equation_, out, options_);
    inside_ = equation_.admissible(as_span<Real>(std::as_const(v_)));
    norm_ = evaluate(v_, r_);
    if (!std::isfinite(norm_)) fail_at_start();
    while (norm_ > Real(0) && iterate()) {
    }
    if (too_stiff_) return unsquared_newton<Real>(equation_, out, options_);
    if (!inside_)
      throw numerical_error(
          "the stage equation has no admissible root near its explicit part (Newton's method ends outside "
          "the admissible set); reduce the time step, or use an unconditionally SSP method",
          {-1, std::nan(""), -1, static_cast<double>(v_[0])});
    Eigen::Map<column<Real>>(out.data(), v_.size()) = v_;
    return {iteration_, static_cast<double>(norm_), static_cast<double>(step_), iteration_};
  }

 private:
  Real evaluate(const column<Real>& v, column<Real>& r) {
    equation_.residual(as_span<Real>(v), as_span(r));
    return r.allFinite() ? largest<Real>(r) : std::numeric_limits<Real>::infinity();
  }

  /// Takes one Newton step with backtracking; returns false when v is a root to round-off.
  bool iterate() {
    if (++iteration_ > options_.max_iterations) fail_to_converge();
    const auto [delta, noise, stiffness, correct] = is_dense()
                                                        ? dense_step<Real>(equation_, v_, r_, iteration_)
                                                        : krylov_step<Real>(equation_, v_, r_, iteration_);
    too_stiff_ = stiffness > stiffest(equation_);
    if (too_stiff_) return false;
    const Real of_v = largest<Real>(v_);
    step_ = largest<Real>(delta) / (of_v > Real(0) ? of_v : Real(1));
    // Near a root a full step reduces R quadratically; when that ends, the remainder is rounding.
    const bool small = step_ <= std::sqrt(std::numeric_limits<Real>::epsilon());
    const bool near = small || norm_ <= Real(32) * noise;
    const Real size = size_of(delta);
    if (size <= Real(1)) return end_with(delta);
    for (Real t(1); t >= Real(0x1p-40); t /= Real(2)) {
      trial_ = v_ + t * delta;
      const bool admissible = equation_.admissible(as_span<Real>(std::as_const(trial_)));
      if (inside_ && !admissible) continue;
      const Real norm = evaluate(trial_, trial_r_);
      // If G is stiff, a step along its slow manifold leaves the manifold by O(Δ²). R amplifies this by
      // (Δt/ε)², but the next step corrects it. Progress therefore shows in the next step with the same R'.
      const bool natural = !small && correct && norm < std::numeric_limits<Real>::infinity() &&
                           largest<Real>(correct(trial_r_)) <= (Real(1) - t / Real(2)) * largest<Real>(delta);
      if (natural || norm <= (Real(1) - Real(1e-4) * t) * norm_) {
        const bool stagnates = near && !natural && norm > norm_ / Real(2);
        v_.swap(trial_);
        r_.swap(trial_r_);
        norm_ = norm;
        inside_ = admissible;
        if (t == Real(1) && correct && size < std::numeric_limits<Real>::infinity())
          return repeat(correct, size);
        return !stagnates;
      }
      if (near) {
        if (!small) fail_in_noise();
        // The maximum norm is that of the largest unknowns; the step may still improve small ones.
        if (norm <= Real(32) * noise) v_.swap(trial_);
        return false;
      }
    }
    if (near) return false;
    fail_to_reduce();
  }

  bool is_dense() const {
    return options_.solver == linear_solver::dense ||
           (options_.solver == linear_solver::automatic && equation_.size() <= options_.dense_limit);
  }

  Real size_of(const column<Real>& delta) {
    return equation_.size_of_correction(as_span<Real>(std::as_const(v_)), as_span<Real>(delta));
  }

  /// Repeats corrections with the same R' while they become much smaller; returns false at the root.
  bool repeat(const std::function<column<Real>(const column<Real>&)>& correct, Real size) {
    for (int k = 0; k < 8; ++k) {
      const column<Real> next = correct(r_);
      const Real of_next = size_of(next);
      if (of_next <= Real(1)) return end_with(next);
      if (!(of_next <= size / Real(8))) return true;
      trial_ = v_ + next;
      const bool admissible = equation_.admissible(as_span<Real>(std::as_const(trial_)));
      const Real norm = evaluate(trial_, trial_r_);
      if ((inside_ && !admissible) || !(norm < std::numeric_limits<Real>::infinity())) return true;
      v_.swap(trial_);
      r_.swap(trial_r_);
      norm_ = norm;
      inside_ = admissible;
      size = of_next;
    }
    return true;
  }

  /// Adds the last correction, unless the result is not admissible or its residual is not finite.
  bool end_with(const column<Real>& delta) {
    trial_ = v_ + delta;
    const bool admissible = equation_.admissible(as_span<Real>(std::as_const(trial_)));
    const Real norm = evaluate(trial_, trial_r_);
    if ((inside_ && !admissible) || !(norm < std::numeric_limits<Real>::infinity())) return false;
    v_.swap(trial_);
    norm_ = norm;
    inside_ = admissible;
    return false;
  }

  [[noreturn]] void fail_at_start() {
    Eigen::Index worst = 0;
    while (worst + 1 < r_.size() && std::isfinite(r_[worst]) && std::isfinite(v_[worst])) ++worst;
    throw numerical_error(fmt::format("the explicit part of a stage, or G or Ġ there, is not finite "
                                      "(component {}); reduce the time step, or check G",
                                      worst),
                          {-1, std::nan(""), -1, static_cast<double>(v_[worst])});
  }

  [[noreturn]] void fail_to_reduce() {
    throw numerical_error(fmt::format(
        "Newton's method cannot reduce the residual {:.3g} of the stage equation any further {}(at "
        "iteration {} there seems to be no {}root); reduce the time step, or use an unconditionally SSP "
        "method",
        static_cast<double>(norm_), inside_ ? "inside the admissible set " : "", iteration_,
        inside_ ? "admissible " : ""));
  }

  [[noreturn]] void fail_in_noise() {
    throw numerical_error(fmt::format(
        "the stage equation is singular to working precision (Newton step {:.2g} relative to v at "
        "iteration {}, although the residual is below its rounding errors); {}",
        static_cast<double>(step_), iteration_, advice));
  }

  [[noreturn]] void fail_to_converge() {
    throw numerical_error(
        fmt::format("Newton's method does not converge on the stage equation (residual {:.3g}, relative step "
                    "{:.3g} after {} iterations); reduce the time step, or allow more iterations",
                    static_cast<double>(norm_), static_cast<double>(step_), options_.max_iterations));
  }

  stage_equation<Real>& equation_;
  newton_options options_;
  column<Real> v_, r_, trial_, trial_r_;
  Real norm_ = Real(0), step_ = Real(0);
  int iteration_ = 0;
  bool inside_ = true;
  bool too_stiff_ = false;  ///< the stage must be solved without squares of G'
};

}  // namespace

template <class Real>
newton_report guarded_newton(stage_equation<Real>& equation, std::span<Real> v,
                             const newton_options& options) {
  return newton<Real>(equation, v, options).solve(v);
}

template newton_report guarded_newton(stage_equation<double>&, std::span<double>, const newton_options&);
template newton_report guarded_newton(stage_equation<long double>&, std::span<long double>,
                                      const newton_options&);

}  // namespace apsis
