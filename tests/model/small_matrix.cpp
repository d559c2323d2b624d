// Matrices with few rows agree with Eigen.
#include <apsis/model/formulas/small_matrix.hpp>

#include <cmath>

#include <Eigen/Dense>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace small_matrix_test {

namespace {

double number(double from, double to) {
  return from + (to - from) * *rc::gen::inRange(0, 10'001) / 1e4;
}

/// Returns R Rᵀ plus a multiple of I. Its condition is at most 260.
template <int N>
Eigen::Matrix<double, N, N> positive_definite() {
  Eigen::Matrix<double, N, N> root;
  for (int i = 0; i < N; ++i)
    for (int j = 0; j < N; ++j) root(i, j) = number(-1.0, 1.0);
  return root * root.transpose() + 0.1 * Eigen::Matrix<double, N, N>::Identity();
}

template <int N>
apsis::scalar::small_matrix<N> small(const Eigen::Matrix<double, N, N>& of) {
  apsis::scalar::small_matrix<N> same;
  for (int i = 0; i < N; ++i)
    for (int j = 0; j < N; ++j) same.of[i][j] = of(i, j);
  return same;
}

/// The tolerance is the rounding of a dozen operations times the square of the condition. An inverse by
/// cofactors may lose this factor.
constexpr double close = 1e-11;

template <int N>
void check_solution() {
  const auto a = positive_definite<N>();
  const apsis::scalar::cholesky_factor<N> factor(small<N>(a));
  RC_ASSERT(factor.positive_definite);
  double x[N];
  Eigen::Matrix<double, N, 1> right;
  for (int i = 0; i < N; ++i) x[i] = right[i] = number(-1.0, 1.0);
  factor.solve(x);
  const Eigen::Matrix<double, N, 1> exact = a.ldlt().solve(right);
  for (int i = 0; i < N; ++i) RC_ASSERT(std::abs(x[i] - exact[i]) <= close * exact.norm());
}

template <int N>
void check_inverse() {
  const auto a = positive_definite<N>();
  const auto product = apsis::scalar::product_of(small<N>(a), apsis::scalar::inverse_of(small<N>(a)));
  for (int i = 0; i < N; ++i)
    for (int j = 0; j < N; ++j) RC_ASSERT(std::abs(product.of[i][j] - (i == j ? 1.0 : 0.0)) <= close);
  RC_ASSERT(std::abs(product.trace() - N) <= N * close);
}

/// Compares the factorization with the signs of the eigenvalues, unless one of them is a rounding error.
template <int N>
void check_definiteness() {
  Eigen::Matrix<double, N, N> a = positive_definite<N>();
  a -= number(0.0, 2.0) * Eigen::Matrix<double, N, N>::Identity();
  const double least = a.template selfadjointView<Eigen::Lower>().eigenvalues().minCoeff();
  RC_PRE(std::abs(least) > 1e-12);
  RC_ASSERT(apsis::scalar::cholesky_factor<N>(small<N>(a)).positive_definite == (least > 0.0));
}

}  // namespace

RC_GTEST_PROP(small_matrix, systems_have_the_solutions_of_eigen, ()) {
  check_solution<3>();
  check_solution<4>();
  check_solution<5>();
}

RC_GTEST_PROP(small_matrix, inverses_give_the_unit_matrix, ()) {
  check_inverse<1>();
  check_inverse<2>();
  check_inverse<3>();
}

RC_GTEST_PROP(small_matrix, the_factor_exists_for_positive_eigenvalues, ()) {
  check_definiteness<1>();
  check_definiteness<2>();
  check_definiteness<3>();
}

TEST(small_matrix, a_matrix_with_a_number_that_is_not_one_is_not_definite) {
  apsis::scalar::small_matrix<2> a;
  a.of[0][0] = 1.0;
  a.of[1][1] = std::nan("");
  EXPECT_FALSE(apsis::scalar::cholesky_factor<2>(a).positive_definite);
}

}  // namespace small_matrix_test
