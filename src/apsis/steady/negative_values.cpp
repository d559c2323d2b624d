#include <apsis/steady/negative_values.hpp>

#include <apsis/core/errors.hpp>
#include <apsis/core/index.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include <Eigen/Dense>

namespace apsis {
namespace {

/// Makes single rows nonnegative.
class row_projection {
 public:
  explicit row_projection(const relaxation_model& equation)
      : equation_(equation),
        omega_(at(equation.moment_count())),
        left_(omega_.size()),
        found_(at(field::padded(equation.components()))),
        components_(at(equation.components())) {}

  /// Returns false if the row has no equilibrium.
  bool apply(double* row) {
    equation_.moments(row, omega_.data());
    return scale_rest(row) || mix_with_equilibrium(row);
  }
  const double* moments() const { return omega_.data(); }

 private:
  using matrix = Eigen::MatrixXd;

  /// Replaces the row by max(f, 0)(1 + Σ_i a_i W_i). W_i are the functions on the components with
  /// ω_i = Σ_k W_ik f_k. Returns false, with the row unchanged, if a factor is negative or the moments
  /// differ.
  bool scale_rest(double* row) {
    make_weights();
    for (std::size_t k = 0; k < components_; ++k) found_[k] = std::max(row[k], 0.0);
    // The first correction is exact but for its rounding errors, and the second one removes these.
    constexpr int corrections = 2;
    for (int n = 0; n < corrections; ++n)
      if (!correct()) return false;
    if (!has_moments()) return false;
    std::copy_n(found_.begin(), components_, row);
    return true;
  }

  /// Applies W_ik to unit rows, because models do not name these functions.
  void make_weights() {
    if (weights_.size() > 0) return;
    weights_.resize(static_cast<Eigen::Index>(omega_.size()), static_cast<Eigen::Index>(components_));
    aligned_vector<double> unit(found_.size(), 0.0);
    for (std::size_t k = 0; k < components_; ++k) {
      unit[k] = 1.0;
      equation_.moments(unit.data(), left_.data());
      unit[k] = 0.0;
      for (std::size_t i = 0; i < left_.size(); ++i)
        weights_(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k)) = left_[i];
    }
  }

  /// found ← found (1 + Σ_i a_i W_i) with the moments ω. Returns false if a factor is negative.
  bool correct() {
    equation_.moments(found_.data(), left_.data());
    for (std::size_t i = 0; i < left_.size(); ++i) left_[i] = omega_[i] - left_[i];
    const Eigen::Map<const Eigen::VectorXd> values(found_.data(), weights_.cols()),
        defect(left_.data(), weights_.rows());
    const matrix gram = weights_ * values.asDiagonal() * weights_.transpose();
    // Moments have different units: each is scaled to a variance of 1. One that vanishes on the row stays.
    const Eigen::VectorXd unit =
        gram.diagonal().unaryExpr([](double x) { return x > 0.0 ? 1.0 / std::sqrt(x) : 0.0; });
    const matrix scaled = unit.asDiagonal() * gram * unit.asDiagonal();
    const Eigen::VectorXd solved =
        unit.cwiseProduct(scaled.completeOrthogonalDecomposition().solve(unit.cwiseProduct(defect)));
    const Eigen::VectorXd factors = (weights_.transpose() * solved).array() + 1.0;
    if (!(factors.minCoeff() >= 0.0)) return false;
    for (std::size_t k = 0; k < components_; ++k) found_[k] *= factors[static_cast<Eigen::Index>(k)];
    return true;
  }

  /// Returns true if the moments of the found row are ω but for rounding.
  bool has_moments() {
    // Both sums over the components are rounded.
    constexpr double rounding = 16.0 * std::numeric_limits<double>::epsilon();
    equation_.moments(found_.data(), left_.data());
    const Eigen::Map<const Eigen::VectorXd> values(found_.data(), weights_.cols());
    const Eigen::VectorXd sizes = weights_.cwiseAbs() * values;
    for (std::size_t i = 0; i < left_.size(); ++i)
      if (!(std::abs(omega_[i] - left_[i]) <= rounding * sizes[static_cast<Eigen::Index>(i)])) return false;
    return true;
  }

  bool mix_with_equilibrium(double* row) {
    if (!equation_.equilibrium(omega_.data(), found_.data())) return false;
    double share = 0.0;
    for (std::size_t k = 0; k < components_; ++k)
      if (row[k] < 0.0) share = std::max(share, row[k] / (row[k] - found_[k]));
    for (std::size_t k = 0; k < components_; ++k)
      row[k] = std::max((1.0 - share) * row[k] + share * found_[k], 0.0);
    return true;
  }

  const relaxation_model& equation_;
  std::vector<double> omega_, left_;
  aligned_vector<double> found_;  ///< with the padding of rows
  std::size_t components_;
  matrix weights_;  ///< W, made on first use
};

}  // namespace

removed_values remove_negative_values(const relaxation_model& equation, const domain& space,
                                      const std::vector<int>& cells, field& f) {
  removed_values removed;
  row_projection project(equation);
  for (const int cell : cells) {
    double* row = f.row(cell);
    const std::int64_t before = removed.count;
    for (int k = 0; k < f.components(); ++k)
      if (row[k] < 0.0) {
        ++removed.count;
        removed.lowest = std::min(removed.lowest, row[k]);
      }
    if (removed.count > before && !project.apply(row))
      throw numerical_error(equation.why_inadmissible(project.moments()),
                            {.cell = space.number_in_whole_mesh(cell), .value = project.moments()[0]});
  }
  return removed;
}

}  // namespace apsis
