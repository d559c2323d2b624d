#pragma once

#include <apsis/steady/internal/moment_equations.hpp>
#include <apsis/steady/internal/sparse_factors.hpp>

#include <array>
#include <memory>
#include <vector>

#include <Eigen/Dense>
#include <Eigen/SparseCore>

namespace apsis {

/// An approximate inverse of J, a preconditioner if factors of J are too large. It performs steps in
/// pseudo-time that are implicit along one direction after the other (Peaceman & Rachford, J. SIAM 3, 1955),
///     Π_d (Θ_k + J_d) Θ_k⁻¹,  Θ_k = k flights + k² spreads,
/// for wave numbers k from that of the domain to that of the mesh. The number of steps grows with the
/// logarithm of the number of cells along a direction.
class alternating_directions {
 public:
  /// Factorizes the lines for each k. `mesh` must outlive the object. Throws numerical_error if a
  /// matrix is singular.
  alternating_directions(const moment_mesh& mesh, const moment_equations& equations);

  /// Returns the number of wave numbers for a ratio `range` of the largest to the smallest one.
  static int steps(double range);

  /// Returns an approximation of J⁻¹ r, with the rows and columns of bordered_matrix().
  Eigen::VectorXd solve(const Eigen::VectorXd& r) const;

 private:
  /// Some lines along a direction. The factors are in single precision: reading them takes most of the time
  /// of solve(), and an approximation does not need more digits.
  struct lines {
    std::vector<int> unknowns;  ///< in the order of the rows of `factors`
    std::unique_ptr<sparse_factors_of<float>> factors = {};
  };
  struct stage {
    std::vector<double> scale;                ///< Θ_k, [number][moments²]
    std::array<std::vector<lines>, 3> along;  ///< Θ_k + J_d
  };

  void add_stage(const moment_equations& equations, double wave_number);
  std::vector<lines> factorized_lines(const moment_equations& equations, int direction,
                                      const std::vector<double>& scale) const;
  Eigen::VectorXd without_sums(const Eigen::VectorXd& r) const;
  /// Returns for each column the sum of a moment times the volumes of cells, divided by the number of cells.
  Eigen::RowVectorXd sums_of(const Eigen::MatrixXd& x, int moment) const;

  const moment_mesh& mesh_;
  std::vector<int> conserved_;
  row_matrix matrix_;  ///< J without the equations of sums
  std::vector<stage> stages_;
  Eigen::MatrixXd of_sources_;  ///< approximate responses to sources that are equal in all cells
  Eigen::PartialPivLU<Eigen::MatrixXd> sums_;
};

}  // namespace apsis
