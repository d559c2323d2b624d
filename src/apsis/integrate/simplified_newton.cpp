// GCC warns about the deliberately undefined register of its AVX-512 intrinsics, which Eigen uses.
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif

#include <apsis/integrate/simplified_newton.hpp>

#include <apsis/integrate/internal/kept_derivative.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace apsis {
namespace {

/// Largest accepted estimate of the remaining error of a stage, in units of the accuracy that it needs. It is
/// below 1, because errors of stages add up in a step.
template <class Real>
constexpr Real accepted_rest = Real(0.125);

/// Largest last correction in these units. In stiff systems the contraction in the maximum norm may seem far
/// better in one correction than in the next.
template <class Real>
constexpr Real accepted_correction = Real(8);

/// One stage.
template <class Real>
class simplified_stage {
  using column = Eigen::Matrix<Real, Eigen::Dynamic, 1>;

 public:
  simplified_stage(timed_stage_equation<Real>& equation, kept_derivative<Real>& kept, Real t,
                   std::span<const Real> start)
      : equation_(equation),
        kept_(kept),
        t_(t),
        a_(equation.terms().a),
        v_(Eigen::Map<const column>(start.data(), static_cast<Eigen::Index>(start.size()))),
        r_(v_.size()),
        delta_(v_.size()),
        before_(v_.size()),
        trial_(v_.size()),
        trial_r_(v_.size()) {}

  /// Returns whether v is the solution.
  bool solve() {
    if (!equation_.admissible(view(v_)) || !residual(v_, r_)) return false;
    if (!kept_.provide(equation_, t_, view(v_))) return false;
    // With J at an iterate, Newton's method gains digits by itself. If three such J do not suffice, steps
    // need the guards of guarded_newton().
    for (int matrices = 0; matrices < 3; ++matrices) {
      if (matrices > 0 && !kept_.refresh(equation_, t_, view(v_))) return false;
      switch (iterate(kept_.factors(a_))) {
        case end::solved:
          return true;
        case end::failed:
          return false;
        case end::slow:
          break;
      }
    }
    return false;
  }

  newton_report report() const {
    const Real of_v = largest(v_);
    return {corrections_, static_cast<double>(largest(r_)),
            static_cast<double>(largest(delta_) / (of_v > Real(0) ? of_v : Real(1))), 0};
  }
  const column& solution() const { return v_; }

 private:
  enum class end { solved, slow, failed };

  /// Corrects v with one matrix.
  end iterate(const kept_factors<Real>& factors) {
    for (int k = 0; k < most_corrections; ++k) {
      before_.swap(delta_);
      delta_ = -r_;
      factors.solve(delta_);
      ++corrections_;
      const Real size = size_of(delta_);
      if (!(size < std::numeric_limits<Real>::infinity())) return end::failed;
      // Both sizes are in the units of the same v: tolerances of a v that jumps would distort the
      // contraction.
      const Real theta = k > 0 ? size / size_of(before_) : expected_contraction();
      if (k > 0) {
        // A correction that rounding errors dominate does not measure the quality of the matrix.
        if (size > accepted_rest<Real>) kept_.measured(theta);
        if (!(theta < slowest)) return size <= accepted_rest<Real> ? accept() : end::slow;
      }
      const Real rest = theta / (Real(1) - theta) * size;
      if (theta < slowest && size <= accepted_correction<Real> && rest <= accepted_rest<Real>)
        return accept();
      const bool slow = k > 0 && corrections_to_go(theta, rest) > affordable();
      if (!advance()) return k > 0 ? end::slow : end::failed;
      if (slow) return end::slow;
    }
    return end::slow;
  }

  Real size_of(const column& delta) { return equation_.size_of_correction(view(v_), view(delta)); }

  /// Returns the expected θ of a first correction. It exceeds that of the stages before, because these may
  /// have been nearer to the state of J.
  Real expected_contraction() const {
    const auto known = kept_.contraction();
    return known ? std::pow(std::max(*known, std::numeric_limits<Real>::epsilon()), Real(0.8)) : Real(1);
  }

  /// Number of corrections until the rest is accepted.
  static Real corrections_to_go(Real theta, Real rest) {
    return std::ceil(std::log(rest / accepted_rest<Real>) / -std::log(theta));
  }
  /// Returns the number of corrections that a new matrix is worth: its products, and about three corrections
  /// with it.
  Real affordable() const {
    return static_cast<Real>(
        std::min<std::size_t>(3 + kept_.products(static_cast<std::size_t>(v_.size())), 8));
  }

  /// Adds the correction and ends. No residual is evaluated, because no correction follows.
  end accept() {
    trial_ = v_ + delta_;
    if (!trial_.allFinite() || !equation_.admissible(view(trial_))) return end::failed;
    v_.swap(trial_);
    return end::solved;
  }

  /// Adds the correction. Returns false if the result is not admissible or its residual is not finite.
  bool advance() {
    trial_ = v_ + delta_;
    if (!equation_.admissible(view(trial_)) || !residual(trial_, trial_r_)) return false;
    v_.swap(trial_);
    r_.swap(trial_r_);
    return true;
  }

  bool residual(const column& v, column& r) {
    equation_.residual(view(v), {r.data(), static_cast<std::size_t>(r.size())});
    return r.allFinite();
  }

  static std::span<const Real> view(const column& x) {
    return {x.data(), static_cast<std::size_t>(x.size())};
  }
  static Real largest(const column& x) { return x.template lpNorm<Eigen::Infinity>(); }

  static constexpr int most_corrections = 12;
  static constexpr Real slowest = Real(0.5);  ///< θ above which a matrix is not kept

  timed_stage_equation<Real>& equation_;
  kept_derivative<Real>& kept_;
  Real t_, a_;
  column v_, r_, delta_, before_, trial_, trial_r_;
  int corrections_ = 0;
};

}  // namespace

template <class Real>
struct simplified_newton<Real>::parts {
  parts(std::optional<sparsity_pattern> pattern, std::optional<mass_matrix<Real>> mass)
      : kept(std::move(pattern), std::move(mass)) {}
  kept_derivative<Real> kept;
};

template <class Real>
simplified_newton<Real>::simplified_newton(std::optional<sparsity_pattern> pattern,
                                           std::optional<mass_matrix<Real>> mass)
    : parts_(std::make_unique<parts>(std::move(pattern), std::move(mass))) {}
template <class Real>
simplified_newton<Real>::simplified_newton(const simplified_newton& other)
    : parts_(std::make_unique<parts>(other.parts_->kept.places(), other.parts_->kept.mass())) {}
template <class Real>
simplified_newton<Real>& simplified_newton<Real>::operator=(const simplified_newton& other) {
  if (this != &other) *this = simplified_newton(other);
  return *this;
}
template <class Real>
simplified_newton<Real>::simplified_newton(simplified_newton&&) noexcept = default;
template <class Real>
simplified_newton<Real>& simplified_newton<Real>::operator=(simplified_newton&&) noexcept = default;
template <class Real>
simplified_newton<Real>::~simplified_newton() = default;

template <class Real>
void simplified_newton<Real>::begin_step(Real t, std::span<const Real> u) {
  parts_->kept.begin_step(t, u);
}
template <class Real>
void simplified_newton<Real>::end_step() {
  parts_->kept.end_step();
}

template <class Real>
std::optional<newton_report> simplified_newton<Real>::solve(timed_stage_equation<Real>& equation, Real t,
                                                            std::span<Real> v) {
  const int before = parts_->kept.factorizations();
  simplified_stage<Real> stage(equation, parts_->kept, t, v);
  if (!stage.solve()) return std::nullopt;
  std::copy_n(stage.solution().data(), v.size(), v.begin());
  newton_report report = stage.report();
  report.factorizations = parts_->kept.factorizations() - before;
  return report;
}

template class simplified_newton<double>;
template class simplified_newton<long double>;

}  // namespace apsis
