#pragma once

#include <apsis/integrate/internal/sparse_factors.hpp>
#include <apsis/integrate/internal/stage_system.hpp>
#include <apsis/integrate/mass_matrix.hpp>
#include <apsis/integrate/sparsity_pattern.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <Eigen/SparseCore>

namespace apsis {

/// S as a sparse matrix. Its entries come from one product for each group of columns of the pattern, and the
/// order of elimination is found once for each pattern of S. Without b the rates are eliminated, which takes
/// no squares: (M − aJ) δv = r_v + a r_k, M δk = J δv + r_k.
template <class Real>
class sparse_stage_system final : public stage_system<Real> {
  using column = typename stage_system<Real>::column;
  using matrix = Eigen::SparseMatrix<Real, Eigen::ColMajor, int>;

 public:
  /// Of a problem whose G', and mass matrix if there is one, has this pattern.
  sparse_stage_system(sparsity_pattern pattern, std::optional<mass_matrix<Real>> mass)
      : pattern_(std::move(pattern)),
        mass_(std::move(mass)),
        masses_(masses_at(pattern_, mass_ ? &*mass_ : nullptr)),
        jacobian_(pattern_.entries()),
        curved_(pattern_.entries()) {
    reduced_.entries = make_matrix(false);
    whole_.entries = make_matrix(true);
  }

  bool linearize(stage_equation<Real>& equation, const column& x) override {
    a_ = equation.terms().a;
    b_ = equation.terms().b;
    now_ = b_ != Real(0) ? &whole_ : &reduced_;
    if (!differentiate(equation, x)) return false;
    fill(now_->entries);
    now_->factorize();
    return true;
  }

  column solve(const column& r) const override {
    if (b_ != Real(0)) return now_->solve(r);
    const Eigen::Index n = r.size() / 2;
    column x(2 * n);
    x.head(n) = now_->solve(r.head(n) + a_ * r.tail(n));
    x.tail(n) = r.tail(n);
    for_each_entry(
        [&](std::size_t i, std::size_t j, std::size_t e) { x[n + index(i)] += jacobian_[e] * x[index(j)]; });
    if (mass_) mass_->divide({x.data() + n, static_cast<std::size_t>(n)});
    return x;
  }

  column sizes_times(const column& x) const override {
    column y = column::Zero(x.size());
    for_each_entry([&](std::size_t i, std::size_t j, std::size_t e) {
      y[index(i)] += std::abs(jacobian_[e]) * x[index(j)];
    });
    return y;
  }

  column changes_of_rates(const column& sizes) const override {
    column least = column::Constant(index(pattern_.size()), std::numeric_limits<Real>::infinity());
    for_each_entry([&](std::size_t i, std::size_t j, std::size_t e) {
      const Real effect = std::abs(b_ * jacobian_[e] + a_ * masses_[e]);
      if (effect > Real(0)) least[index(j)] = std::min(least[index(j)], sizes[index(i)] / effect);
    });
    return least;
  }

  /// Returns 4 times the root mean square over errors with signs of a fixed pseudo-random sequence. The
  /// factor covers errors that add up.
  column spread(const column& sizes) const override {
    constexpr int probes = 6;
    std::uint64_t bits = 0x9e3779b97f4a7c15u;
    column squares = column::Zero(sizes.size()), errors(sizes.size());
    for (int k = 0; k < probes; ++k) {
      for (Eigen::Index i = 0; i < sizes.size(); ++i) {
        bits ^= bits << 13, bits ^= bits >> 7, bits ^= bits << 17;
        errors[i] = (bits >> 40 & 1u) != 0 ? sizes[i] : -sizes[i];
      }
      squares += solve(errors).cwiseAbs2();
    }
    return Real(4) * (squares / Real(probes)).cwiseSqrt();
  }

 private:
  static Eigen::Index index(std::size_t i) { return static_cast<Eigen::Index>(i); }

  /// Calls body(row, column, entry) for every entry of the pattern.
  template <class Body>
  void for_each_entry(const Body& body) const {
    for (std::size_t j = 0; j < pattern_.size(); ++j) {
      std::size_t e = pattern_.begin(j);
      for (const std::size_t i : pattern_.rows(j)) body(i, j, e++);
    }
  }

  /// Sets J and, if b ≠ 0, H from one product for each group. Unit vectors are scaled to the sizes of the
  /// unknowns, as differences need. Returns whether all entries are finite.
  bool differentiate(stage_equation<Real>& equation, const column& x) {
    const std::size_t n = pattern_.size();
    const std::span<const Real> v(x.data(), n), k(x.data() + n, n);
    std::vector<Real> unit(n, Real(0)), scale(n, Real(1)), jx(n), hx(n);
    const Real largest = x.head(index(n)).template lpNorm<Eigen::Infinity>();
    for (std::size_t j = 0; j < n && largest > Real(0); ++j)
      scale[j] = stage_system<Real>::power_of_2(std::max(std::abs(v[j]), Real(1e-6) * largest));
    for (const auto& group : pattern_.groups()) {
      for (const std::size_t j : group) unit[j] = scale[j];
      if (b_ != Real(0)) {
        equation.rate_curvature(v, k, unit, jx, hx);
      } else {
        equation.differential(v, unit, jx, hx);  // −a G'(v) x
        for (Real& value : jx) value /= -a_;
      }
      for (const std::size_t j : group) {
        unit[j] = Real(0);
        std::size_t e = pattern_.begin(j);
        for (const std::size_t i : pattern_.rows(j)) {
          jacobian_[e] = jx[i] / scale[j];
          curved_[e++] = hx[i] / scale[j];
        }
      }
    }
    Real none(0);
    for (std::size_t e = 0; e < jacobian_.size(); ++e) none += (jacobian_[e] + curved_[e]) * Real(0);
    return none == Real(0);
  }

  /// Makes a matrix with the pattern of S, or of M − aJ.
  matrix make_matrix(bool whole) const {
    const std::size_t n = pattern_.size();
    std::vector<Eigen::Triplet<Real>> places;
    for_each_entry([&](std::size_t i, std::size_t j, std::size_t) {
      const int row = static_cast<int>(i), col = static_cast<int>(j), below = static_cast<int>(n);
      places.emplace_back(row, col, Real(1));
      if (!whole) return;
      places.emplace_back(below + row, col, Real(1));
      places.emplace_back(row, below + col, Real(1));
      if (i == j || mass_) places.emplace_back(below + row, below + col, Real(1));
    });
    const int size = static_cast<int>(whole ? 2 * n : n);
    matrix made(size, size);
    made.setFromTriplets(places.begin(), places.end());
    return made;
  }

  /// Sets the entries in the order of columns and, within a column, of rows, as make_matrix() did.
  void fill(matrix& m) const {
    Real* to = m.valuePtr();
    const bool whole = b_ != Real(0);
    const std::size_t n = pattern_.size();
    for (std::size_t j = 0; j < n; ++j) {
      const std::size_t begin = pattern_.begin(j);
      const auto rows = pattern_.rows(j);
      for (std::size_t k = 0; k < rows.size(); ++k)
        *to++ = masses_[begin + k] - (whole ? b_ * curved_[begin + k] : a_ * jacobian_[begin + k]);
      if (!whole) continue;
      for (std::size_t k = 0; k < rows.size(); ++k) *to++ = -jacobian_[begin + k];
    }
    for (std::size_t j = 0; whole && j < n; ++j) {
      const std::size_t begin = pattern_.begin(j);
      const auto rows = pattern_.rows(j);
      for (std::size_t k = 0; k < rows.size(); ++k)
        *to++ = -b_ * jacobian_[begin + k] - a_ * masses_[begin + k];
      for (std::size_t k = 0; k < rows.size(); ++k)
        if (rows[k] == j || mass_) *to++ = masses_[begin + k];
    }
  }

  sparsity_pattern pattern_;
  std::optional<mass_matrix<Real>> mass_;
  std::vector<Real> masses_,              ///< entries of M
      jacobian_, curved_;                 ///< entries of J and H
  sparse_factors<Real> whole_, reduced_;  ///< S; M − aJ, if b = 0
  sparse_factors<Real>* now_ = nullptr;
  Real a_ = Real(0), b_ = Real(0);
};

}  // namespace apsis
