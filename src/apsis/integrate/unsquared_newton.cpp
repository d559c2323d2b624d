// GCC warns about the deliberately undefined register of its AVX-512 intrinsics, which Eigen uses.
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif

#include <apsis/integrate/unsquared_newton.hpp>

#include <apsis/core/errors.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include <Eigen/Dense>
#include <fmt/format.h>

namespace apsis {
namespace {

template <class Real>
class unsquared {
  using column = Eigen::Matrix<Real, Eigen::Dynamic, 1>;
  using square = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;
  static constexpr Real rounding = std::numeric_limits<Real>::epsilon();
  static constexpr Real accurate = Real(8);  ///< corrections of a few roundings are not improved any further

 public:
  unsquared(stage_equation<Real>& equation, std::span<Real> start, const newton_options& options)
      : equation_(equation),
        options_(options),
        n_(static_cast<Eigen::Index>(start.size())),
        a_(equation.terms().a),
        b_(equation.terms().b),
        explicit_part_(Eigen::Map<const column>(equation.terms().explicit_part.data(), n_)),
        x_(2 * n_),
        r_(2 * n_),
        trial_(2 * n_),
        trial_r_(2 * n_),
        jk_(n_),
        g_(n_) {
    x_.head(n_) = Eigen::Map<column>(start.data(), n_);
    x_.tail(n_).setZero();
  }

  newton_report solve(std::span<Real> out) {
    inside_ = admissible(x_);
    if (!residual(x_, r_)) fail("is not finite at the explicit part");
    while (iterate()) {
    }
    require_accurate();
    if (!inside_)
      throw numerical_error(
          "the stage equation has no admissible root near its explicit part (Newton's method ends outside "
          "the admissible set); reduce the time step, or use an unconditionally SSP method",
          {-1, std::nan(""), -1, static_cast<double>(x_[0])});
    Eigen::Map<column>(out.data(), n_) = x_.head(n_);
    return {iteration_, static_cast<double>(largest(r_)), static_cast<double>(step_)};
  }

 private:
  static Real largest(const column& x) { return x.template lpNorm<Eigen::Infinity>(); }

  /// Takes one Newton step with backtracking; returns false when it ends at a root to rounding.
  bool iterate() {
    if (++iteration_ > options_.max_iterations)
      fail(fmt::format("is not solved in {} iterations", options_.max_iterations));
    linearize();
    const column delta = correction(r_);
    const Real size = level(delta), of_v = largest(x_.head(n_));
    step_ = largest(delta.head(n_)) / (of_v > Real(0) ? of_v : Real(1));
    if (!(size < std::numeric_limits<Real>::infinity()))
      fail_singular(std::numeric_limits<double>::infinity());
    if (equation_.negligible(v_of(x_), v_of(delta))) return end_with(delta);
    for (Real t(1); t >= Real(0x1p-40); t /= Real(2)) {
      trial_ = x_ + t * delta;
      const bool inside = admissible(trial_);
      if ((inside_ && !inside) || !residual(trial_, trial_r_)) continue;
      const column next = correction(trial_r_);
      const Real of_next = level(next);
      if (!(of_next <= std::max((Real(1) - t / Real(2)) * size, accurate))) continue;
      inside_ = inside;
      x_.swap(trial_);
      r_.swap(trial_r_);
      if (of_next > accurate || t < Real(1)) return true;
      trial_ = x_ + next;
      if (!inside_ || admissible(trial_)) x_.swap(trial_);
      return false;
    }
    if (!is_small(delta)) fail("seems to have no root near its explicit part");
    return false;
  }

  /// Adds a negligible correction, unless that leaves the admissible set or what is finite.
  bool end_with(const column& delta) {
    trial_ = x_ + delta;
    const bool inside = admissible(trial_);
    if ((inside_ && !inside) || !residual(trial_, trial_r_)) return false;
    inside_ = inside;
    x_.swap(trial_);
    r_.swap(trial_r_);
    return false;
  }

  std::span<const Real> v_of(const column& x) const { return {x.data(), static_cast<std::size_t>(n_)}; }
  std::span<const Real> k_of(const column& x) const { return {x.data() + n_, static_cast<std::size_t>(n_)}; }
  static std::span<Real> span_of(column& x) { return {x.data(), static_cast<std::size_t>(x.size())}; }

  bool admissible(const column& x) { return equation_.admissible(v_of(x)); }

  /// Sets r to the residual at x; returns whether it is finite.
  bool residual(const column& x, column& r) {
    equation_.rate(v_of(x), span_of(g_));
    r.head(n_) = (x.head(n_) - explicit_part_) - a_ * x.tail(n_);
    r.tail(n_) = x.tail(n_) - g_;
    if (b_ != Real(0)) {
      equation_.rate_product(v_of(x), k_of(x), span_of(jk_));
      r.head(n_) -= b_ * jk_;
    }
    return r.allFinite();
  }

  /// Factorizes M at x_ and estimates the rounding errors of its unknowns.
  void linearize() {
    square m = square::Identity(2 * n_, 2 * n_);
    column unit = column::Zero(n_), jx(n_), hx = column::Zero(n_);
    square jacobian(n_, n_);
    for (Eigen::Index i = 0; i < n_; ++i) {
      unit[i] = Real(1);
      equation_.rate_curvature(v_of(x_), k_of(x_), v_of(unit), span_of(jx), span_of(hx));
      unit[i] = Real(0);
      jacobian.col(i) = jx;
      if (b_ != Real(0)) m.col(i).head(n_) -= b_ * hx;
    }
    m.topRightCorner(n_, n_) = -b_ * jacobian;
    m.topRightCorner(n_, n_).diagonal().array() -= a_;
    m.bottomLeftCorner(n_, n_) = -jacobian;
    if (!m.allFinite()) fail("has no finite derivative");
    // Sizes of the terms of the residual, G being a sum of terms about |G'| |v|.
    const square sizes = jacobian.cwiseAbs();
    column terms(2 * n_);
    terms.head(n_) = x_.head(n_).cwiseAbs() + explicit_part_.cwiseAbs() +
                     std::abs(a_) * x_.tail(n_).cwiseAbs() + std::abs(b_) * (sizes * x_.tail(n_).cwiseAbs());
    equation_.rate(v_of(x_), span_of(g_));
    terms.tail(n_) = x_.tail(n_).cwiseAbs() + g_.cwiseAbs() + sizes * x_.head(n_).cwiseAbs();
    equilibrate(m);
    lu_.compute(rows_.asDiagonal() * m * cols_.asDiagonal());
    const square inverse = cols_.asDiagonal() * lu_.inverse() * rows_.asDiagonal();
    noise_ = rounding * (inverse.cwiseAbs() * terms + x_.cwiseAbs());
    // A rate need not be more accurate than the residual shows: one that vanishes has no terms, but rounding
    // errors of the linear solve.
    for (Eigen::Index i = 0; i < n_; ++i) {
      const auto effects = m.col(n_ + i).head(n_).cwiseAbs();
      Real invisible = std::numeric_limits<Real>::infinity();
      for (Eigen::Index j = 0; j < n_; ++j)
        if (effects[j] > Real(0)) invisible = std::min(invisible, rounding * terms[j] / effects[j]);
      if (invisible < std::numeric_limits<Real>::infinity())
        noise_[n_ + i] = std::max(noise_[n_ + i], invisible);
    }
  }

  /// Chooses powers of 2 that bring the largest entries of rows and columns near 1.
  void equilibrate(const square& m) {
    rows_ = column::Ones(2 * n_);
    cols_ = column::Ones(2 * n_);
    const square sizes = m.cwiseAbs();
    for (int sweep = 0; sweep < 3; ++sweep) {
      for (Eigen::Index i = 0; i < 2 * n_; ++i) {
        rows_[i] = power_of_2(Real(1) / sizes.row(i).cwiseProduct(cols_.transpose()).maxCoeff());
      }
      for (Eigen::Index i = 0; i < 2 * n_; ++i)
        cols_[i] = power_of_2(Real(1) / sizes.col(i).cwiseProduct(rows_).maxCoeff());
    }
  }
  static Real power_of_2(Real x) { return std::exp2(std::round(std::log2(x))); }

  column correction(const column& r) const {
    return -(cols_.asDiagonal() * lu_.solve(rows_.asDiagonal() * r));
  }

  /// max |δ_i| in units of the rounding error of unknown i; +infinity if an entry is NaN.
  Real level(const column& delta) const {
    Real largest(0);
    for (Eigen::Index i = 0; i < delta.size(); ++i) {
      const Real size = std::abs(delta[i]);
      if (size == Real(0) || noise_[i] == Real(0))
        continue;  // all terms are 0, and the correction is rounding
      const Real ratio = size / noise_[i];
      if (!(ratio <= largest)) largest = ratio;
      if (!(ratio <= std::numeric_limits<Real>::max())) return std::numeric_limits<Real>::infinity();
    }
    return largest;
  }

  bool is_small(const column& delta) const {
    const Real bound = std::sqrt(rounding);
    for (Eigen::Index i = 0; i < n_; ++i)
      if (!(std::abs(delta[i]) <= std::max(bound * std::abs(x_[i]), accurate * noise_[i]))) return false;
    return true;
  }

  void require_accurate() const {
    const Real lost = largest(noise_.head(n_)),
               size = std::max({largest(x_.head(n_)), largest(explicit_part_), equation_.terms().size});
    if (!(lost <= Real(1e-3) * size)) fail_singular(static_cast<double>(lost / size));
  }

  [[noreturn]] void fail(const std::string& what) const {
    throw numerical_error(
        fmt::format("the stage equation {} (Newton iteration {}, relative step {:.3g}); reduce "
                    "the time step, or use an unconditionally SSP method",
                    what, iteration_, static_cast<double>(step_)));
  }
  [[noreturn]] void fail_singular(double lost) const {
    throw numerical_error(fmt::format(
        "the stage equation is singular to working precision (rounding errors of G move its "
        "solution by {:.2g} of its size at Newton iteration {}, Δt being too many times longer than "
        "the fastest time of G); reduce the time step, or use relaxation_problem",
        lost, iteration_));
  }

  stage_equation<Real>& equation_;
  newton_options options_;
  Eigen::Index n_;
  Real a_, b_;
  column explicit_part_, x_, r_, trial_, trial_r_, jk_, g_;
  column rows_, cols_, noise_;      ///< scales of M; rounding errors of the unknowns
  Eigen::PartialPivLU<square> lu_;  ///< of the scaled M
  Real step_ = Real(0);
  int iteration_ = 0;
  bool inside_ = true;
};

}  // namespace

template <class Real>
newton_report unsquared_newton(stage_equation<Real>& equation, std::span<Real> v,
                               const newton_options& options) {
  return unsquared<Real>(equation, v, options).solve(v);
}

template newton_report unsquared_newton(stage_equation<double>&, std::span<double>, const newton_options&);
template newton_report unsquared_newton(stage_equation<long double>&, std::span<long double>,
                                        const newton_options&);

}  // namespace apsis
