#pragma once

#include <apsis/steady/internal/alternating_directions.hpp>
#include <apsis/steady/internal/frontal_factors.hpp>
#include <apsis/steady/internal/moment_equations.hpp>
#include <apsis/steady/internal/neutral_mode.hpp>

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include <Eigen/SparseCore>

namespace apsis {

/// Solves moment equations. Small systems are factorized. Factors of an earlier J precondition GMRES for a
/// later one, as long as few iterations do. Where factors are too large, alternating_directions precondition
/// it, those of an earlier J too.
class moment_solver {
 public:
  /// `mesh` must outlive the object.
  explicit moment_solver(const moment_mesh& mesh);

  /// Takes another J. `holds_neutral`: whether solve() leaves a neutral mode as it is; it is only sought
  /// where J is factorized. Throws numerical_error if J is singular.
  void take(moment_equations equations, bool holds_neutral);
  /// Whether solve() leaves a neutral mode as it is.
  bool has_neutral_mode() const { return neutral_.has_value(); }
  /// Returns x with J x = r, and prescribed sums. Throws numerical_error if J is singular.
  Eigen::VectorXd solve(Eigen::VectorXd r);

  /// Returns whether J is factorized for a mesh of so many directions.
  static bool factorizes(int directions, double unknowns);
  /// Estimates the numbers per cell in factors of J or of its lines.
  static double numbers_of_cell(int directions, int moments, double cells);

 private:
  using preconditioner = std::function<Eigen::VectorXd(const Eigen::VectorXd&)>;
  void factorize_again();
  void renew_directions();
  std::optional<Eigen::VectorXd> solve_with_directions(const Eigen::VectorXd& r);
  std::vector<int> ends_of_parts() const;
  std::optional<Eigen::VectorXd> iterate(const Eigen::VectorXd& r, const preconditioner& approximate,
                                         double tolerance, int iterations);

  const moment_mesh& mesh_;
  bool factorizes_;
  row_matrix matrix_;
  std::unique_ptr<frontal_factors> factors_;
  bool are_those_of_matrix_ = false;           ///< the factors
  int iterations_ = 0;                         ///< with this matrix
  std::optional<moment_equations> equations_;  ///< J, where directions precondition it
  std::unique_ptr<alternating_directions> directions_;
  int iterations_of_new_ = 0;  ///< with directions of the same J, those of the first right side; 0: unknown
  std::optional<neutral_mode> neutral_;
};

}  // namespace apsis
