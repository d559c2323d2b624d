// GCC warns about the deliberately undefined register of its AVX-512 intrinsics, which Eigen uses.
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif

#include <apsis/integrate/unsquared_newton.hpp>

#include <apsis/core/errors.hpp>
#include <apsis/integrate/internal/dense_stage_system.hpp>
#include <apsis/integrate/internal/sparse_stage_system.hpp>

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
  static constexpr Real rounding = std::numeric_limits<Real>::epsilon();
  static constexpr Real accurate = Real(8);  ///< corrections of a few roundings are not improved any further

 public:
  unsquared(stage_equation<Real>& equation, stage_system<Real>& system, std::span<Real> start,
            const newton_options& options)
      : equation_(equation),
        system_(system),
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
        g_(n_),
        mass_(equation.mass()) {
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
    return {iteration_, static_cast<double>(largest(r_)), static_cast<double>(step_), iteration_};
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
    const Real needed = size_of(delta);
    if (needed <= Real(1)) return end_with(delta);
    for (Real t(1); t >= Real(0x1p-40); t /= Real(2)) {
      // Near a root a full step gains digits. If it does not, the rest consists of errors of G and of its
      // derivatives, and those of differences are larger than rounding. Parts of a step would never end.
      if (t < Real(1) && is_small(delta)) return false;
      trial_ = x_ + t * delta;
      const bool inside = admissible(trial_);
      if ((inside_ && !inside) || !residual(trial_, trial_r_)) continue;
      const column next = correction(trial_r_);
      const Real of_next = level(next);
      if (!(of_next <= std::max((Real(1) - t / Real(2)) * size, accurate))) continue;
      inside_ = inside;
      x_.swap(trial_);
      r_.swap(trial_r_);
      if (t == Real(1) && needed < std::numeric_limits<Real>::infinity()) return repeat(needed);
      if (of_next > accurate || t < Real(1)) return true;
      trial_ = x_ + next;
      if (!inside_ || admissible(trial_)) x_.swap(trial_);
      return false;
    }
    if (!is_small(delta)) fail("seems to have no root near its explicit part");
    return false;
  }

  Real size_of(const column& delta) { return equation_.size_of_correction(v_of(x_), v_of(delta)); }

  /// Repeats corrections with the same S while they become much smaller; returns false at the root.
  bool repeat(Real size) {
    for (int k = 0; k < 8; ++k) {
      const column next = correction(r_);
      const Real of_next = size_of(next);
      if (of_next <= Real(1)) return end_with(next);
      if (!(of_next <= size / Real(8))) return true;
      trial_ = x_ + next;
      const bool inside = admissible(trial_);
      if ((inside_ && !inside) || !residual(trial_, trial_r_)) return true;
      inside_ = inside;
      x_.swap(trial_);
      r_.swap(trial_r_);
      size = of_next;
    }
    return true;
  }

  /// Adds the last correction, unless the result is not admissible or its residual is not finite.
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
    r.head(n_) = masses((x.head(n_) - explicit_part_) - a_ * x.tail(n_));
    r.tail(n_) = masses(x.tail(n_)) - g_;
    if (b_ != Real(0)) {
      equation_.rate_product(v_of(x), k_of(x), span_of(jk_));
      r.head(n_) -= b_ * jk_;
    }
    return r.allFinite();
  }

  /// Returns M x.
  column masses(const column& x) const {
    if (mass_ == nullptr) return x;
    column y(n_);
    mass_->multiply(v_of(x), span_of(y));
    return y;
  }
  /// Returns |M| x.
  column mass_sizes(const column& x) const {
    if (mass_ == nullptr) return x;
    column y(n_);
    mass_->multiply_sizes(v_of(x), span_of(y));
    return y;
  }

  /// Factorizes S at x_ and estimates the rounding errors of its unknowns.
  void linearize() {
    if (!system_.linearize(equation_, x_)) fail("has no finite derivative");
    // Sizes of the terms of the residual. Those of G are about |G'| |v|.
    column terms(2 * n_);
    terms.head(n_) = mass_sizes(x_.head(n_).cwiseAbs() + explicit_part_.cwiseAbs() +
                                std::abs(a_) * x_.tail(n_).cwiseAbs()) +
                     std::abs(b_) * system_.sizes_times(x_.tail(n_).cwiseAbs());
    equation_.rate(v_of(x_), span_of(g_));
    terms.tail(n_) =
        mass_sizes(x_.tail(n_).cwiseAbs()) + g_.cwiseAbs() + system_.sizes_times(x_.head(n_).cwiseAbs());
    noise_ = rounding * (system_.spread(terms) + x_.cwiseAbs());
    // A rate need not be more accurate than the residual shows. A rate that vanishes has no terms, but
    // rounding errors of the linear solve.
    const column invisible = rounding * system_.changes_of_rates(terms.head(n_));
    for (Eigen::Index i = 0; i < n_; ++i)
      if (invisible[i] < std::numeric_limits<Real>::infinity())
        noise_[n_ + i] = std::max(noise_[n_ + i], invisible[i]);
  }

  column correction(const column& r) const { return -system_.solve(r); }

  /// Returns max |δ_i| in units of the rounding error of unknown i; +infinity if an entry is NaN.
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
  stage_system<Real>& system_;
  newton_options options_;
  Eigen::Index n_;
  Real a_, b_;
  column explicit_part_, x_, r_, trial_, trial_r_, jk_, g_;
  const mass_matrix<Real>* mass_;  ///< M; null for 1
  column noise_;                   ///< rounding errors of the unknowns
  Real step_ = Real(0);
  int iteration_ = 0;
  bool inside_ = true;
};

}  // namespace

template <class Real>
newton_report unsquared_newton(stage_equation<Real>& equation, std::span<Real> v,
                               const newton_options& options) {
  dense_stage_system<Real> system;
  return unsquared<Real>(equation, system, v, options).solve(v);
}

template newton_report unsquared_newton(stage_equation<double>&, std::span<double>, const newton_options&);
template newton_report unsquared_newton(stage_equation<long double>&, std::span<long double>,
                                        const newton_options&);

template <class Real>
struct sparse_newton<Real>::parts {
  parts(const sparsity_pattern& of, std::optional<mass_matrix<Real>> with)
      : pattern(of), mass(std::move(with)), system(pattern, mass) {}
  sparsity_pattern pattern;
  std::optional<mass_matrix<Real>> mass;
  sparse_stage_system<Real> system;
};

template <class Real>
sparse_newton<Real>::sparse_newton(const sparsity_pattern& pattern, std::optional<mass_matrix<Real>> mass)
    : parts_(std::make_unique<parts>(pattern, std::move(mass))) {}
template <class Real>
sparse_newton<Real>::sparse_newton(const sparse_newton& other)
    : sparse_newton(other.parts_->pattern, other.parts_->mass) {}
template <class Real>
sparse_newton<Real>& sparse_newton<Real>::operator=(const sparse_newton& other) {
  if (this != &other) *this = sparse_newton(other);
  return *this;
}
template <class Real>
sparse_newton<Real>::sparse_newton(sparse_newton&&) noexcept = default;
template <class Real>
sparse_newton<Real>& sparse_newton<Real>::operator=(sparse_newton&&) noexcept = default;
template <class Real>
sparse_newton<Real>::~sparse_newton() = default;

template <class Real>
bool sparse_newton<Real>::fits(std::size_t n) const {
  return n == parts_->pattern.size();
}

template <class Real>
newton_report sparse_newton<Real>::solve(stage_equation<Real>& equation, std::span<Real> v,
                                         const newton_options& options) {
  if (!fits(v.size()))
    throw input_error(
        fmt::format("the sparsity pattern has {} unknowns and the state {} (they differ in number); "
                    "give the pattern of the derivative of this state",
                    parts_->pattern.size(), v.size()));
  return unsquared<Real>(equation, parts_->system, v, options).solve(v);
}

template class sparse_newton<double>;
template class sparse_newton<long double>;

}  // namespace apsis
