#pragma once

#include <apsis/integrate/internal/stage_system.hpp>
#include <apsis/integrate/mass_matrix.hpp>

#include <algorithm>
#include <limits>
#include <span>

namespace apsis {

/// S as a full matrix.
template <class Real>
class dense_stage_system final : public stage_system<Real> {
  using column = typename stage_system<Real>::column;
  using square = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;

 public:
  bool linearize(stage_equation<Real>& equation, const column& x) override {
    const Eigen::Index n = x.size() / 2;
    const Real a = equation.terms().a, b = equation.terms().b;
    const auto half = [n](const column& of, Eigen::Index from) {
      return std::span<const Real>(of.data() + from, static_cast<std::size_t>(n));
    };
    const square mass = mass_of(equation, n);
    square m(2 * n, 2 * n);
    m.topLeftCorner(n, n) = mass;
    m.bottomRightCorner(n, n) = mass;
    column unit = column::Zero(n), jx(n), hx = column::Zero(n);
    square jacobian(n, n);
    for (Eigen::Index i = 0; i < n; ++i) {
      unit[i] = Real(1);
      equation.rate_curvature(half(x, 0), half(x, n), half(unit, 0), {jx.data(), static_cast<std::size_t>(n)},
                              {hx.data(), static_cast<std::size_t>(n)});
      unit[i] = Real(0);
      jacobian.col(i) = jx;
      if (b != Real(0)) m.col(i).head(n) -= b * hx;
    }
    m.topRightCorner(n, n) = -b * jacobian - a * mass;
    m.bottomLeftCorner(n, n) = -jacobian;
    if (!m.allFinite()) return false;
    sizes_ = jacobian.cwiseAbs();
    effects_ = m.topRightCorner(n, n).cwiseAbs();
    equilibrate(m);
    lu_.compute(rows_.asDiagonal() * m * cols_.asDiagonal());
    inverse_ = (cols_.asDiagonal() * lu_.inverse() * rows_.asDiagonal()).cwiseAbs();
    return true;
  }

  column solve(const column& r) const override {
    return cols_.asDiagonal() * lu_.solve(rows_.asDiagonal() * r);
  }
  column sizes_times(const column& x) const override { return sizes_ * x; }
  column spread(const column& sizes) const override { return inverse_ * sizes; }
  column changes_of_rates(const column& sizes) const override {
    column least = column::Constant(effects_.cols(), std::numeric_limits<Real>::infinity());
    for (Eigen::Index i = 0; i < effects_.cols(); ++i)
      for (Eigen::Index j = 0; j < effects_.rows(); ++j)
        if (effects_(j, i) > Real(0)) least[i] = std::min(least[i], sizes[j] / effects_(j, i));
    return least;
  }

 private:
  static square mass_of(const stage_equation<Real>& equation, Eigen::Index n) {
    if (equation.mass() == nullptr) return square::Identity(n, n);
    return Eigen::Map<const square>(equation.mass()->columns().data(), n, n);
  }

  /// Chooses powers of 2 that bring the largest entries of rows and columns near 1.
  void equilibrate(const square& m) {
    rows_ = column::Ones(m.rows());
    cols_ = column::Ones(m.rows());
    const square sizes = m.cwiseAbs();
    for (int sweep = 0; sweep < 3; ++sweep) {
      for (Eigen::Index i = 0; i < m.rows(); ++i)
        rows_[i] =
            stage_system<Real>::power_of_2(Real(1) / sizes.row(i).cwiseProduct(cols_.transpose()).maxCoeff());
      for (Eigen::Index i = 0; i < m.rows(); ++i)
        cols_[i] = stage_system<Real>::power_of_2(Real(1) / sizes.col(i).cwiseProduct(rows_).maxCoeff());
    }
  }

  square sizes_, effects_,          ///< |J|, |−aM − bJ|
      inverse_;                     ///< |S⁻¹|
  column rows_, cols_;              ///< scales of S
  Eigen::PartialPivLU<square> lu_;  ///< of the scaled S
};

}  // namespace apsis
