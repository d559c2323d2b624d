#include <apsis/steady/internal/neutral_mode.hpp>

#include <cmath>
#include <random>

#include <Eigen/Dense>

namespace apsis {
namespace {

using columns = Eigen::Matrix<double, Eigen::Dynamic, 2>;

/// The error decreases by (σ₁/σ₂)² per iteration, and by (σ₂/σ₃)² for the second value, which
/// is only compared.
constexpr int iterations = 4;
constexpr double isolated = 1e-3;

columns orthonormal(const Eigen::HouseholderQR<columns>& decomposed) {
  const Eigen::Index rows = decomposed.matrixQR().rows();
  return decomposed.householderQ() * columns::Identity(rows, 2);
}

/// Returns numbers between −1 and 1, the same in every run.
columns start(Eigen::Index rows) {
  std::mt19937 numbers;  // NOLINT(cert-msc32-c,cert-msc51-cpp): the same in every run
  columns found(rows, 2);
  for (double& x : found.reshaped()) x = 2.0 * (static_cast<double>(numbers()) / 4294967295.0) - 1.0;
  return found;
}

}  // namespace

std::optional<neutral_mode> find_neutral_mode(const frontal_factors& factors) {
  if (factors.rows() < 2) return std::nullopt;
  columns right = start(factors.rows()), left(factors.rows(), 2);
  double smallest = 0.0, next = 0.0;
  for (int k = 0; k < iterations; ++k) {
    for (int i = 0; i < 2; ++i) left.col(i) = factors.solve_transposed(right.col(i));
    left = orthonormal(Eigen::HouseholderQR<columns>(left));
    for (int i = 0; i < 2; ++i) right.col(i) = factors.solve(left.col(i));
    const Eigen::HouseholderQR<columns> decomposed(right);
    smallest = 1.0 / std::abs(decomposed.matrixQR()(0, 0));
    next = 1.0 / std::abs(decomposed.matrixQR()(1, 1));
    right = orthonormal(decomposed);
  }
  if (!(smallest < isolated * next)) return std::nullopt;
  return neutral_mode{left.col(0), right.col(0)};
}

}  // namespace apsis
