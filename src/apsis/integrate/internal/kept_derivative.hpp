#pragma once

#include <apsis/integrate/internal/band_factors.hpp>
#include <apsis/integrate/internal/sparse_factors.hpp>
#include <apsis/integrate/internal/stage_system.hpp>
#include <apsis/integrate/mass_matrix.hpp>
#include <apsis/integrate/simplified_newton.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <Eigen/Dense>

namespace apsis {

/// Entries of a derivative J = G'(t, v): of a full matrix by columns, or of the places of a pattern.
template <class Real>
class derivative_entries {
 public:
  /// Sets the entries by one product for each column, or group of columns. Unit vectors are scaled to the
  /// sizes of the unknowns, as differences need. Returns whether all entries are finite.
  bool evaluate(timed_stage_equation<Real>& equation, const sparsity_pattern* pattern, Real t,
                std::span<const Real> v) {
    const std::size_t n = v.size();
    std::vector<Real> unit(n, Real(0)), jx(n);
    values.resize(pattern != nullptr ? pattern->entries() : n * n);
    Real largest(0);
    for (const Real value : v) largest = std::max(largest, std::abs(value));
    const auto scale = [&](std::size_t j) {
      return largest > Real(0)
                 ? stage_system<Real>::power_of_2(std::max(std::abs(v[j]), Real(1e-6) * largest))
                 : Real(1);
    };
    if (pattern == nullptr) {
      for (std::size_t j = 0; j < n; ++j) {
        unit[j] = scale(j);
        equation.product_at(t, v, unit, jx);
        for (std::size_t i = 0; i < n; ++i) values[j * n + i] = jx[i] / unit[j];
        unit[j] = Real(0);
      }
    } else {
      for (const auto& group : pattern->groups()) {
        for (const std::size_t j : group) unit[j] = scale(j);
        equation.product_at(t, v, unit, jx);
        for (const std::size_t j : group) {
          std::size_t e = pattern->begin(j);
          for (const std::size_t i : pattern->rows(j)) values[e++] = jx[i] / unit[j];
          unit[j] = Real(0);
        }
      }
    }
    return std::all_of(values.begin(), values.end(), [](Real x) { return std::isfinite(x); });
  }

  std::vector<Real> values;
};

/// Factors of M − aJ for one a; M is the mass matrix, or 1.
template <class Real>
class kept_factors {
 public:
  using column = Eigen::Matrix<Real, Eigen::Dynamic, 1>;
  virtual ~kept_factors() = default;
  /// Factorizes M − aJ.
  virtual void factorize(Real a, const std::vector<Real>& j) = 0;
  /// Sets x ← (M − aJ)⁻¹ x; its numbers are not finite where the matrix is singular.
  virtual void solve(column& x) const = 0;
};

/// The factors of a full matrix, scaled so that neither the units of the unknowns nor stiffness choose the
/// pivots.
template <class Real>
class kept_dense_factors final : public kept_factors<Real> {
  using square = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;

 public:
  using column = typename kept_factors<Real>::column;

  /// With the mass matrix, which null replaces by 1.
  explicit kept_dense_factors(const mass_matrix<Real>* mass) {
    if (mass != nullptr) mass_ = mass->columns();
  }

  void factorize(Real a, const std::vector<Real>& j) override {
    const auto n = static_cast<Eigen::Index>(std::llround(std::sqrt(static_cast<double>(j.size()))));
    m_ = -a * Eigen::Map<const square>(j.data(), n, n);
    if (mass_.empty())
      m_.diagonal().array() += Real(1);
    else
      m_ += Eigen::Map<const square>(mass_.data(), n, n);
    rows_ = m_.cwiseAbs().rowwise().maxCoeff().cwiseInverse();
    m_ = rows_.asDiagonal() * m_;
    cols_ = m_.cwiseAbs().colwise().maxCoeff().cwiseInverse().transpose();
    m_ = m_ * cols_.asDiagonal();
    lu_.compute(m_);
  }
  void solve(column& x) const override {
    x = rows_.cwiseProduct(x);
    x = lu_.solve(x);
    x = cols_.cwiseProduct(x);
  }

 private:
  std::vector<Real> mass_;  ///< M by columns; empty for 1
  square m_;
  column rows_, cols_;
  Eigen::PartialPivLU<square> lu_;
};

/// The factors of a sparse matrix.
template <class Real>
class kept_sparse_factors final : public kept_factors<Real> {
 public:
  using column = typename kept_factors<Real>::column;

  kept_sparse_factors(const sparsity_pattern& pattern, const mass_matrix<Real>* mass)
      : masses_(masses_at(pattern, mass)) {
    const auto n = static_cast<int>(pattern.size());
    std::vector<Eigen::Triplet<Real>> places;
    for (std::size_t j = 0; j < pattern.size(); ++j)
      for (const std::size_t i : pattern.rows(j))
        places.emplace_back(static_cast<int>(i), static_cast<int>(j), Real(1));
    factors_.entries.resize(n, n);
    factors_.entries.setFromTriplets(places.begin(), places.end());
  }

  void factorize(Real a, const std::vector<Real>& j) override {
    Real* to = factors_.entries.valuePtr();
    for (std::size_t e = 0; e < j.size(); ++e) to[e] = masses_[e] - a * j[e];
    factors_.factorize();
  }
  void solve(column& x) const override { x = factors_.solve(x); }

 private:
  std::vector<Real> masses_;  ///< entries of M
  sparse_factors<Real> factors_;
};

/// How far entries of a pattern are from the diagonal.
struct pattern_band {
  std::size_t lower = 0,  ///< largest row − column
      upper = 0;          ///< largest column − row

  explicit pattern_band(const sparsity_pattern& of) {
    for (std::size_t j = 0; j < of.size(); ++j) {
      upper = std::max(upper, j - std::min(j, of.rows(j).front()));
      lower = std::max(lower, std::max(j, of.rows(j).back()) - j);
    }
  }
  /// Whether factors of the band take no more time than sparse factors, whose overhead is about ten
  /// operations for each operation.
  bool is_narrow() const { return lower * (lower + upper) <= 256; }
};

/// The factors of a band.
template <class Real>
class kept_band_factors final : public kept_factors<Real> {
 public:
  using column = typename kept_factors<Real>::column;

  /// Stores a reference to the pattern.
  kept_band_factors(const sparsity_pattern& pattern, pattern_band band, const mass_matrix<Real>* mass)
      : pattern_(pattern),
        masses_(masses_at(pattern, mass)),
        factors_(pattern.size(), band.lower, band.upper) {}

  void factorize(Real a, const std::vector<Real>& values) override {
    factors_.clear();
    for (std::size_t j = 0; j < pattern_.size(); ++j) {
      std::size_t e = pattern_.begin(j);
      for (const std::size_t i : pattern_.rows(j)) {
        factors_.at(i, j) = masses_[e] - a * values[e];
        ++e;
      }
    }
    factors_.factorize();
  }
  void solve(column& x) const override { factors_.solve({x.data(), static_cast<std::size_t>(x.size())}); }

 private:
  const sparsity_pattern& pattern_;
  std::vector<Real> masses_;  ///< entries of M
  band_factors<Real> factors_;
};

/// The derivative of a step, with the factors for every a of its stages.
template <class Real>
class kept_derivative {
 public:
  /// The pattern contains the places of the mass matrix.
  kept_derivative(std::optional<sparsity_pattern> pattern, std::optional<mass_matrix<Real>> mass)
      : pattern_(std::move(pattern)), mass_(std::move(mass)) {}
  kept_derivative(const kept_derivative&) = delete;  // factors refer to the pattern
  kept_derivative& operator=(const kept_derivative&) = delete;

  /// The pattern; nothing for full matrices.
  const std::optional<sparsity_pattern>& places() const { return pattern_; }
  /// The mass matrix; nothing for 1.
  const std::optional<mass_matrix<Real>>& mass() const { return mass_; }
  /// Number of products that a derivative costs.
  std::size_t products(std::size_t n) const { return pattern_ ? pattern_->groups().size() : n; }
  /// Number of matrices factorized so far.
  int factorizations() const { return factorizations_; }
  /// Largest θ of the present derivative in this step, if one was measured.
  std::optional<Real> contraction() const { return contraction_; }
  void measured(Real theta) { contraction_ = std::max(theta, contraction_.value_or(Real(0))); }

  /// States that a step begins with u at t. The derivative there is known if the last step that needed one
  /// began there, too.
  void begin_step(Real t, std::span<const Real> u) {
    const bool same = has_base_ && t == t_ && std::equal(u.begin(), u.end(), u_.begin(), u_.end());
    if (!same) {
      has_base_ = false;
      t_ = t;
      u_.assign(u.begin(), u.end());
    }
    if (!same || now_ != &base_) use(same ? &base_ : nullptr);
    contraction_.reset();
    inside_ = true;
  }
  void end_step() { inside_ = false; }

  /// Provides the derivative for a stage that starts at v. Returns false if it is not finite.
  bool provide(timed_stage_equation<Real>& equation, Real t, std::span<const Real> v) {
    if (!inside_) return refresh(equation, t, v);
    if (now_ != nullptr) return true;
    if (!has_base_) has_base_ = base_.evaluate(equation, pattern(pattern_), t_, u_);
    if (has_base_) use(&base_);
    return has_base_;
  }

  /// Evaluates the derivative at v and uses it from now on. Returns false if it is not finite.
  bool refresh(timed_stage_equation<Real>& equation, Real t, std::span<const Real> v) {
    use(nullptr);
    if (!fresh_.evaluate(equation, pattern(pattern_), t, v)) return false;
    use(&fresh_);
    return true;
  }

  /// Returns the factors of M − aJ, valid until J changes.
  const kept_factors<Real>& factors(Real a) {
    for (std::size_t k = 0; k < used_; ++k)
      if (all_[k].first == a) return *all_[k].second;
    if (used_ == all_.size()) all_.emplace_back(a, make_factors());
    auto& [of, factors] = all_[used_++];
    of = a;
    factors->factorize(a, now_->values);
    ++factorizations_;
    return *factors;
  }

 private:
  static const sparsity_pattern* pattern(const std::optional<sparsity_pattern>& of) {
    return of ? &*of : nullptr;
  }

  /// Continues with other entries, or without any.
  void use(const derivative_entries<Real>* entries) {
    now_ = entries;
    used_ = 0;
    contraction_.reset();
  }

  std::unique_ptr<kept_factors<Real>> make_factors() const {
    const mass_matrix<Real>* mass = mass_ ? &*mass_ : nullptr;
    if (!pattern_) return std::make_unique<kept_dense_factors<Real>>(mass);
    if (const pattern_band band(*pattern_); band.is_narrow())
      return std::make_unique<kept_band_factors<Real>>(*pattern_, band, mass);
    return std::make_unique<kept_sparse_factors<Real>>(*pattern_, mass);
  }

  std::optional<sparsity_pattern> pattern_;
  std::optional<mass_matrix<Real>> mass_;
  bool inside_ = false;                            ///< whether a step has begun
  Real t_ = Real(0);                               ///< time at which it began
  std::vector<Real> u_;                            ///< its beginning
  derivative_entries<Real> base_, fresh_;          ///< J there, and at a later iterate
  bool has_base_ = false;                          ///< whether base_ is J at t_ and u_
  const derivative_entries<Real>* now_ = nullptr;  ///< base_, fresh_ or nothing
  std::vector<std::pair<Real, std::unique_ptr<kept_factors<Real>>>> all_;
  std::size_t used_ = 0;  ///< number of factors of now_
  int factorizations_ = 0;
  std::optional<Real> contraction_;
};

}  // namespace apsis
