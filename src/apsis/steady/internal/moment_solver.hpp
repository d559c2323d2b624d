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

/// Solves moment equations. Small systems are factorized. The factors of an earlier J precondition GMRES for
/// a later one if few iterations suffice. If factors would be too large, alternating_directions precondition
/// GMRES instead. Those of an earlier J may serve a later one too.
class moment_solver {
 public:
  /// `mesh` must outlive the object.
  explicit moment_solver(const moment_mesh& mesh);

  /// Replaces J. If `holds_neutral`, solve() does not change a neutral mode; such a mode is sought only if J
  /// is factorized. Throws numerical_error if J is singular.
  void take(moment_equations equations, bool holds_neutral);
  /// Returns true if solve() does not change a neutral mode.
  bool has_neutral_mode() const { return neutral_.has_value(); }
  /// Returns x with J x = r and prescribed sums. Throws numerical_error if J is singular, or if it is too
  /// large to factorize and GMRES does not converge.
  Eigen::VectorXd solve(Eigen::VectorXd r);

  /// Returns true if J is factorized for a mesh of this many directions and unknowns.
  static bool factorizes(int directions, double unknowns);
  /// Returns an estimate of the numbers per cell in factors of J or of its lines.
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
  bool are_those_of_matrix_ = false;           ///< whether the factors are those of matrix_
  int iterations_ = 0;                         ///< iterations with this matrix
  std::optional<moment_equations> equations_;  ///< J, if directions precondition it
  std::unique_ptr<alternating_directions> directions_;
  int iterations_of_new_ = 0;  ///< iterations of the first solution with new directions; 0: unknown
  std::optional<neutral_mode> neutral_;
};

}  // namespace apsis
