// Dense and multifrontal LU factors.
#include <apsis/steady/internal/frontal_factors.hpp>

#include <apsis/core/errors.hpp>
#include <apsis/exec/parallel.hpp>
#include <apsis/steady/internal/dense_factors.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <random>
#include <vector>

#include <Eigen/Dense>
#include <gtest/gtest.h>

namespace frontal_factors_test {
namespace {

using apsis::frontal_factors;
using apsis::row_matrix;
using apsis::dense_product::block;
using Eigen::MatrixXd;
using Eigen::VectorXd;

MatrixXd noise(int rows, int columns, unsigned seed) {
  std::mt19937 generator(seed);
  std::normal_distribution<double> number;
  MatrixXd found(rows, columns);
  for (double& x : found.reshaped()) x = number(generator);
  return found;
}

block block_of(MatrixXd& all) {
  return {all.data(), static_cast<int>(all.rows()), static_cast<int>(all.cols()), all.outerStride()};
}

/// Returns a matrix of unknowns on a line. Each is connected with the next `reach` ones, and the last one
/// with all.
row_matrix banded(int rows, int reach, unsigned seed) {
  std::mt19937 generator(seed);
  std::normal_distribution<double> number;
  std::vector<Eigen::Triplet<double>> terms;
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < rows; ++j)
      if (std::abs(i - j) <= reach || i == rows - 1 || j == rows - 1) {
        // The block of a part is regular, but not diagonally dominant.
        const double diagonal = i == j ? 2.0 * std::sqrt(2.0 * reach + 1.0) : 0.0;
        terms.emplace_back(i, j, diagonal + number(generator));
      }
  row_matrix matrix(rows, rows);
  matrix.setFromTriplets(terms.begin(), terms.end());
  return matrix;
}

/// Returns the ends of parts with 1 to `most` unknowns.
std::vector<int> random_ends(int rows, int most, unsigned seed) {
  std::mt19937 generator(seed);
  std::vector<int> ends;
  for (int end = 0; end < rows;) {
    end = std::min(rows, end + 1 + static_cast<int>(generator() % static_cast<unsigned>(most)));
    ends.push_back(end);
  }
  return ends;
}

double error_of(const frontal_factors& factors, const row_matrix& matrix) {
  const VectorXd exact = noise(static_cast<int>(matrix.rows()), 1, 7);
  return (factors.solve(matrix * exact) - exact).norm() / exact.norm();
}

}  // namespace

TEST(dense_product, subtracts_blocks_of_any_size_and_touches_nothing_else) {
  std::mt19937 generator(3);
  for (int trial = 0; trial < 60; ++trial) {
    const auto size = [&](unsigned most) { return static_cast<int>(generator() % (most + 1)); };
    const int rows = size(70), columns = size(40), depth = size(300);
    MatrixXd a = noise(rows + 3, depth, 1), b = noise(depth + 2, columns, 2),
             c = noise(rows + 5, columns + 1, 4);
    MatrixXd expected = c;
    expected.block(2, 1, rows, columns) -= a.topRows(rows) * b.topRows(depth);
    apsis::dense_product::subtract(block_of(a).at(0, 0, rows, depth), block_of(b).at(0, 0, depth, columns),
                                   block_of(c).at(2, 1, rows, columns));
    // The entries are sums of `depth` products of size 1 in another order.
    EXPECT_LE((c - expected).cwiseAbs().maxCoeff(), 1e-15 * (depth + 10)) << rows << " " << columns;
    expected.block(2, 1, rows, columns) = c.block(2, 1, rows, columns);
    EXPECT_EQ(c, expected);
  }
}

TEST(dense_factors, multiply_to_the_matrix_with_its_rows_exchanged) {
  for (const auto& [rows, columns] : {std::array{1, 1}, std::array{7, 7}, std::array{9, 9},
                                      std::array{40, 40}, std::array{130, 130}, std::array{150, 37}}) {
    const MatrixXd matrix = noise(rows, columns, 5);
    MatrixXd factors = matrix, exchanged_rows = matrix;
    std::vector<int> pivots(static_cast<std::size_t>(columns));
    ASSERT_TRUE(apsis::dense_factors::factorize(block_of(factors), pivots));
    apsis::dense_factors::exchange_pivot_rows(pivots, block_of(exchanged_rows));
    MatrixXd lower = MatrixXd::Identity(rows, columns);
    lower.triangularView<Eigen::StrictlyLower>() = factors;
    const MatrixXd upper = factors.topRows(columns).triangularView<Eigen::Upper>();
    // For random matrices the growth in Gaussian elimination with pivots is small.
    EXPECT_LE((lower * upper - exchanged_rows).cwiseAbs().maxCoeff(), 1e-14 * rows);
    // The largest remaining entry of a column becomes the pivot.
    EXPECT_LE(lower.cwiseAbs().maxCoeff(), 1.0);
  }
}

TEST(dense_factors, solve_triangular_equations) {
  const int size = 61;
  MatrixXd factors = noise(size, size, 8);
  factors /= 8.0;
  factors.diagonal().array() += 3.0;
  const MatrixXd lower = factors.triangularView<Eigen::UnitLower>(),
                 upper = factors.triangularView<Eigen::Upper>(), right = noise(size, 13, 9),
                 left = noise(13, size, 10);
  MatrixXd x = right, y = left;
  apsis::dense_factors::solve_lower(block_of(factors), block_of(x));
  apsis::dense_factors::solve_upper_from_right(block_of(factors), block_of(y));
  // The triangles are well conditioned.
  EXPECT_LE((lower * x - right).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_LE((y * upper - left).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(dense_factors, find_a_pivot_that_is_0_or_not_a_number) {
  std::vector<int> pivots(20);
  MatrixXd singular = noise(20, 20, 1);
  singular.col(15).setZero();
  EXPECT_FALSE(apsis::dense_factors::factorize(block_of(singular), pivots));
  MatrixXd unknown = noise(20, 20, 1);
  unknown(4, 4) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(apsis::dense_factors::factorize(block_of(unknown), pivots));
}

TEST(frontal_factors, solve_equations_and_transposed_ones_in_any_parts) {
  for (unsigned trial = 0; trial < 30; ++trial) {
    const int rows = 1 + static_cast<int>(trial) * 7, reach = 1 + static_cast<int>(trial % 4);
    const row_matrix matrix = banded(rows, reach, trial);
    frontal_factors factors(random_ends(rows, 12, trial + 1));
    factors.factorize(matrix);
    EXPECT_EQ(factors.rows(), rows);
    // The condition of these matrices is below 1e4.
    EXPECT_LE(error_of(factors, matrix), 1e-10) << rows;
    const VectorXd exact = noise(rows, 1, 7);
    EXPECT_LE((factors.solve_transposed(matrix.transpose() * exact) - exact).norm(), 1e-10 * exact.norm());
  }
}

TEST(frontal_factors, take_matrices_of_other_patterns_and_do_not_depend_on_threads) {
  const int rows = 300;
  const std::vector<int> ends = random_ends(rows, 9, 3);
  frontal_factors factors(ends);
  for (const int reach : {2, 2, 5, 1}) {
    const row_matrix matrix = banded(rows, reach, static_cast<unsigned>(reach));
    factors.factorize(matrix);
    EXPECT_LE(error_of(factors, matrix), 1e-10) << reach;
    frontal_factors threaded(ends);
    apsis::set_threads(4);
    threaded.factorize(matrix);
    apsis::set_threads(1);
    const VectorXd r = noise(rows, 1, 2);
    EXPECT_EQ(factors.solve(r), threaded.solve(r));
  }
}

TEST(frontal_factors, report_a_singular_matrix_and_take_the_next_one) {
  row_matrix matrix = banded(50, 2, 1);
  std::fill(matrix.valuePtr() + matrix.outerIndexPtr()[20], matrix.valuePtr() + matrix.outerIndexPtr()[21],
            0.0);
  frontal_factors factors(random_ends(50, 6, 2));
  try {
    factors.factorize(matrix);
    FAIL() << "no error";
  } catch (const apsis::numerical_error& error) {
    EXPECT_STREQ(error.what(), "the moment equations of the steady state are singular");
  }
  const row_matrix regular = banded(50, 2, 1);
  factors.factorize(regular);
  EXPECT_LE(error_of(factors, regular), 1e-10);
}

TEST(block_matrix, holds_each_block_once) {
  apsis::block_matrix matrix(3, 2);
  matrix.entry(5, 0) += 1.0;
  matrix.entry(4, 1) += 2.0;
  matrix.entry(5, 0) += 3.0;
  matrix.entry(0, 3) -= 1.0;
  EXPECT_EQ(matrix.blocks(), 2U);
  MatrixXd all = MatrixXd::Zero(6, 6);
  for (int row = 0; row < matrix.rows(); ++row)
    matrix.visit_row(row, [&](int column, const double* block) {
      for (int k = 0; k < 4; ++k) all(2 * row + k / 2, 2 * column + k % 2) += block[k];
    });
  MatrixXd expected = MatrixXd::Zero(6, 6);
  expected(5, 0) = 4.0;
  expected(4, 1) = 2.0;
  expected(0, 3) = -1.0;
  EXPECT_EQ(all, expected);
}

}  // namespace frontal_factors_test
