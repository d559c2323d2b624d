#pragma once

#include <apsis/exec/aligned.hpp>
#include <apsis/exec/memory_space.hpp>
#include <apsis/steady/internal/dense_product.hpp>
#include <apsis/steady/internal/moment_equations.hpp>

#include <cstddef>
#include <vector>

#include <Eigen/Core>
#include <Eigen/SparseCore>

namespace apsis {

/// LU factors of a sparse matrix by the multifrontal method (Duff & Reid, ACM Trans. Math. Softw. 9, 1983).
/// The unknowns are eliminated part by part with dense matrices. Pivots are sought only within a part, so
/// that the order of the parts bounds the fill. The result does not depend on the number of threads.
class frontal_factors {
 public:
  /// `ends` has one past the last unknown of each part, in increasing order. The last entry is the
  /// number of rows.
  explicit frontal_factors(const std::vector<int>& ends);

  /// Factorizes a compressed matrix. A matrix with the pattern of the previous one uses the same memory.
  /// Throws numerical_error if the matrix is singular, or if the block of a part and all earlier parts is.
  void factorize(const row_matrix& matrix);
  /// Returns A⁻¹ r.
  Eigen::VectorXd solve(const Eigen::VectorXd& r) const;
  /// Returns A⁻ᵀ r.
  Eigen::VectorXd solve_transposed(const Eigen::VectorXd& r) const;

  /// Returns the number of rows.
  Eigen::Index rows() const { return parts_.back().end; }

 private:
  using column_matrix = Eigen::SparseMatrix<double>;
  using block = dense_product::block;
  using matrix_view = Eigen::Map<const Eigen::MatrixXd, 0, Eigen::OuterStride<>>;

  /// A part and the later unknowns that are connected with it.
  struct front {
    int begin = 0, end = 0;                        ///< unknowns of the part
    std::vector<int> border = {};                  ///< later unknowns, increasing
    std::vector<std::size_t> children = {};        ///< parts below it in the elimination tree
    std::vector<int> pivots = {};                  ///< row that was exchanged with each row
    std::size_t first = 0;                         ///< start of its factors in numbers_
    aligned_vector<double> schur_complement = {};  ///< Schur complement of its border, for the parent

    int size() const { return end - begin; }
    int border_size() const { return static_cast<int>(border.size()); }
  };

  bool has_pattern_of(const row_matrix& matrix) const;
  void find_borders(const column_matrix& columns, const row_matrix& rows);
  void find_levels();
  void place_fronts();
  void eliminate(const column_matrix& columns, const row_matrix& rows, front& part);
  void add_entries(const column_matrix& columns, const row_matrix& rows, const front& part);
  void add_schur_complement(front& from, front& to);

  /// Returns the factors of the block of a part.
  block inside(const front& part);
  /// Returns the rows of its border, times U⁻¹.
  block below(const front& part);
  /// Returns L⁻¹ times the columns of its border.
  block right(const front& part);
  matrix_view inside(const front& part) const;
  matrix_view below(const front& part) const;
  matrix_view right(const front& part) const;

  std::vector<front> parts_;
  /// Lists of parts, level by level. The lists of a level are independent.
  std::vector<std::vector<std::vector<std::size_t>>> levels_;
  std::vector<int> starts_, column_numbers_;  ///< pattern of the rows of the last matrix
  stored_numbers numbers_;                    ///< memory of the factors
};

}  // namespace apsis
