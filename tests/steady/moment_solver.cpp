// Solvers of moment equations: small and large systems, conserved sums, and factors of earlier equations.
#include <apsis/steady/internal/moment_solver.hpp>

#include "gas_problem.hpp"

#include <apsis/core/errors.hpp>
#include <apsis/core/index.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <random>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace moment_solver_test {
namespace {

using apsis::moment_equations;
using apsis::moment_mesh;

/// Returns a mesh of cubes with n cells along each side, numbered with the last direction first.
moment_mesh cube(int directions, int n, int moments) {
  moment_mesh mesh{.directions = directions, .moments = moments, .cells = 1, .spacing = 1.0 / n};
  for (int d = 0; d < directions; ++d) mesh.cells *= n;
  int stride = mesh.cells;
  for (int d = 0; d < directions; ++d) {
    stride /= n;
    for (int first = 0; first < mesh.cells; ++first) {
      if (first / stride % n != 0) continue;
      apsis::line_of_cells line;
      for (int k = 0; k < n; ++k) line.push_back(first + k * stride);
      mesh.lines[static_cast<std::size_t>(d)].push_back(line);
    }
  }

  return mesh;
}

/// Returns equations with fluxes |a| upwind and ν ∇ of every moment and −c ∇ of its neighbour. Walls absorb
/// all moments except the first `closed` ones.
moment_equations flows(const moment_mesh& mesh, double nu, int closed, unsigned seed = 1) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> share(0.5, 1.5);
  moment_equations all(mesh);
  const int m = mesh.moments;
  const std::size_t squares = apsis::at(mesh.cells) * apsis::at(m * m);
  all.flights.assign(squares, 0.0);
  all.spreads.assign(squares, 0.0);
  for (int cell = 0; cell < mesh.cells; ++cell)
    for (int i = 0; i < m; ++i) {
      const std::size_t diagonal = apsis::at(cell * m + i) * apsis::at(m) + apsis::at(i);
      all.flights[diagonal] = 1.0;
      all.spreads[diagonal] = nu;
    }
  for (int d = 0; d < mesh.directions; ++d) {
    auto& terms = all.along[static_cast<std::size_t>(d)];
    const auto leave = [&](int from, int to, int i, double rate) {
      terms.entry(from * m + i, from * m + i) += rate;
      if (to >= 0) terms.entry(to * m + i, from * m + i) -= rate;
    };
    for (const apsis::line_of_cells& line : mesh.lines[static_cast<std::size_t>(d)])
      for (std::size_t k = 0; k <= line.size(); ++k) {
        const int below = k > 0 ? line[k - 1] : -1, above = k < line.size() ? line[k] : -1;
        for (int i = 0; i < m; ++i) {
          const double across = nu / mesh.spacing, swept = share(generator);
          if ((below < 0 || above < 0) && i < closed) continue;
          if (below >= 0) leave(below, above, i, (swept + across) / mesh.spacing);
          if (above >= 0) leave(above, below, i, (0.5 * swept + across) / mesh.spacing);
          // The neighbouring moment acts as a pressure, as in sound.
          if (i == 0 || below < 0 || above < 0) continue;
          for (const int of : {below, above}) {
            terms.entry(below * m + i, of * m + i - 1) += 0.25 / mesh.spacing;
            terms.entry(above * m + i, of * m + i - 1) -= 0.25 / mesh.spacing;
          }
        }
      }
  }
  for (int i = 0; i < closed; ++i) all.conserved.push_back(i);
  return all;
}

Eigen::VectorXd noise(Eigen::Index rows, unsigned seed) {
  std::mt19937 generator(seed);
  std::normal_distribution<double> number;
  Eigen::VectorXd r(rows);
  for (double& x : r) x = number(generator);
  return r;
}

/// Solves for the right-hand side of a known solution. Returns the relative error.
double error_of(apsis::moment_solver& solver, const moment_mesh& mesh, const moment_equations& equations) {
  const Eigen::SparseMatrix<double> matrix = apsis::bordered_matrix(mesh, equations);
  const Eigen::VectorXd exact = noise(matrix.rows(), 7);
  return (solver.solve(matrix * exact) - exact).norm() / exact.norm();
}

}  // namespace

struct moment_solvers : testing::TestWithParam<std::array<int, 2>> {};

TEST_P(moment_solvers, solve_dense_and_rare_systems_with_and_without_conserved_sums) {
  const auto [directions, n] = GetParam();
  const moment_mesh mesh = cube(directions, n, 3);
  for (const double nu : {1e-3, 0.1, 10.0})
    for (const int closed : {0, 1, 3}) {
      const moment_equations equations = flows(mesh, nu, closed);
      apsis::moment_solver solver(mesh);
      solver.take(equations, false);
      // GMRES bounds the error after preconditioning by 1e-4. The preconditioned matrix has a
      // condition below 10.
      EXPECT_LT(error_of(solver, mesh, equations), 1e-3) << nu << " " << closed;
    }
}

INSTANTIATE_TEST_SUITE_P(sizes, moment_solvers,
                         testing::Values(std::array{1, 50}, std::array{2, 20}, std::array{3, 6},
                                         std::array{3, 21}));

TEST(moment_solver, does_not_factorize_large_equations_that_iterations_do_not_solve) {
  // Negative viscosity makes J indefinite, and no step of a line is a part of its inverse.
  const moment_mesh small = cube(3, 6, 1), large = cube(3, 30, 1);
  const moment_equations few = flows(small, -0.1, 0), many = flows(large, -0.1, 0);
  apsis::moment_solver by_factors(small), by_iterations(large);
  by_factors.take(few, false);
  EXPECT_LT(error_of(by_factors, small, few), 1e-6);
  by_iterations.take(many, false);
  EXPECT_THAT(
      [&] { error_of(by_iterations, large, many); },
      testing::ThrowsMessage<apsis::numerical_error>(testing::HasSubstr("27000 unknowns are too many")));
  // The next equations are solved as usual.
  const moment_equations usual = flows(large, 0.1, 0);
  by_iterations.take(usual, false);
  EXPECT_LT(error_of(by_iterations, large, usual), 1e-3);
}

TEST(moment_solver, factorizes_what_is_small) {
  EXPECT_TRUE(apsis::moment_solver::factorizes(1, 50000));
  EXPECT_TRUE(apsis::moment_solver::factorizes(2, 16384));
  EXPECT_TRUE(apsis::moment_solver::factorizes(3, 20480));
  EXPECT_FALSE(apsis::moment_solver::factorizes(2, 270000));
  EXPECT_FALSE(apsis::moment_solver::factorizes(3, 69120));
}

struct later_equations : testing::TestWithParam<std::array<int, 2>> {};

TEST_P(later_equations, are_solved_with_earlier_factors_or_with_new_ones) {
  const auto [directions, n] = GetParam();
  const moment_mesh mesh = cube(directions, n, 3);
  apsis::moment_solver solver(mesh);
  solver.take(flows(mesh, 0.1, 1), false);
  // The later equations are the same, others, others with another size of ν, and ones with one more equation.
  for (const moment_equations& later :
       {flows(mesh, 0.1, 1), flows(mesh, 0.1, 1, 2), flows(mesh, 30.0, 1, 3), flows(mesh, 1e-3, 1, 4)}) {
    solver.take(later, false);
    EXPECT_LT(error_of(solver, mesh, later), 1e-3);
  }
  const moment_equations closed = flows(mesh, 0.1, 2);
  solver.take(closed, false);
  EXPECT_LT(error_of(solver, mesh, closed), 1e-3);
}

// The second mesh is too large for factors of J.
INSTANTIATE_TEST_SUITE_P(sizes, later_equations, testing::Values(std::array{2, 12}, std::array{3, 21}));

TEST(alternating_directions, reduce_errors_of_every_wave_length_on_any_mesh) {
  // The sweeps iterate without GMRES.
  for (const auto& [directions, n] :
       {std::array{2, 16}, std::array{2, 100}, std::array{3, 8}, std::array{3, 24}}) {
    const moment_mesh mesh = cube(directions, n, 2);
    const moment_equations equations = flows(mesh, 0.2, 1);
    const apsis::alternating_directions approximate(mesh, equations);
    const Eigen::SparseMatrix<double> matrix = apsis::bordered_matrix(mesh, equations);
    Eigen::VectorXd error = noise(matrix.rows(), 5);
    const double start = error.norm();
    for (int k = 0; k < 10; ++k) error -= approximate.solve(matrix * error);
    EXPECT_LT(error.norm() / start, 0.05) << directions << " " << n;
  }
}

TEST(lines_of_cells, hold_each_cell_once_in_the_order_of_the_mesh) {
  const auto equation = make_gas("bgk", 2, {4.0, 6}, 2);
  const gas_problem gas = gas_between_walls(equation, 2, 6, 1.0);
  const apsis::cell_links links(gas.space->space());
  std::vector<int> number(links.cells().size());
  std::iota(number.begin(), number.end(), 0);
  for (int d = 0; d < 2; ++d) {
    std::vector<int> all;
    for (const apsis::line_of_cells& line : apsis::lines_along(links, d, number)) {
      for (std::size_t k = 1; k < line.size(); ++k)
        EXPECT_EQ(links.next_or_image(d, true, line[k - 1]), line[k]);
      all.insert(all.end(), line.begin(), line.end());
    }
    std::sort(all.begin(), all.end());
    EXPECT_EQ(all, number) << d;
  }
}

}  // namespace moment_solver_test
