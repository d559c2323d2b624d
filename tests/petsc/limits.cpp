#include "problems.hpp"

#include <cmath>
#include <numeric>
#include <string>
#include <utility>

namespace petsc_limits {

using namespace petsc_runs;

constexpr const char* third_order = "-ts_adapt_type none -ts_apsis_method md-imex-8-3-mixed";

outcome solve_exchange(const std::string& text, double epsilon, int steps, int points = 24) {
  const options now(text);
  run one(line(points, 2, DM_BOUNDARY_PERIODIC));
  exchange problem{.epsilon = epsilon};
  problem.enter(one);
  return one.solve(0.25, 0.25 / steps);
}

double sum_of(const std::vector<double>& u) {
  return std::accumulate(u.begin(), u.end(), 0.0);
}

/// Returns the errors of 32 and 64 steps. The steps are up to 8e9 times as long as ε. The reference solves
/// the same problem in small steps.
std::pair<double, double> errors_of(double epsilon) {
  const auto by = [&](int steps) {
    return solve_exchange(std::string(third_order) + " -snes_stol 1e-12 -ksp_rtol 1e-8", epsilon, steps).u;
  };
  const auto reference = by(512);
  return {distance(by(32), reference), distance(by(64), reference)};
}

TEST(small_epsilon, leaves_the_order_and_the_size_of_the_error) {
  const auto [expected_32, expected_64] = errors_of(1e-8);
  EXPECT_LT(expected_32, 1e-5);
  for (const double epsilon : {1e-7, 1e-8, 1e-9, 1e-10, 1e-12}) {
    const auto [of_32, of_64] = errors_of(epsilon);
    // The reference has 1/512 of the error of 64 steps.
    EXPECT_NEAR(std::log2(of_32 / of_64), 3, 0.3) << epsilon;
    // Terms of size ε are below 1e-6. They change the error by less than that times the error.
    EXPECT_NEAR(of_64, expected_64, 0.05 * expected_64) << epsilon;
  }
}

// Stage solves are accurate to 1e-8 by default.
TEST(conserved_quantities, stay_at_their_values_to_the_tolerance_of_stage_solves) {
  for (const double epsilon : {1e-2, 1e-6, 1e-10}) {
    const double before = sum_of(solve_exchange("-ts_max_steps 0", epsilon, 64).u);
    EXPECT_NEAR(sum_of(solve_exchange(third_order, epsilon, 64).u), before, 1e-8 * before) << epsilon;
  }
}

// The stage equation has another root near u = -1/2, where the derivative of the exchange vanishes. Newton's
// method finds it from u = 0.
TEST(stages, lead_to_the_equilibrium_that_short_steps_reach) {
  const options now(std::string(third_order) + " -snes_stol 1e-12");
  for (const double epsilon : {1e-2, 1e-3, 3e-4, 1e-6}) {
    run one(line(3, 2, DM_BOUNDARY_PERIODIC));
    exchange problem{.epsilon = epsilon};
    problem.enter(one);
    {
      const own_points own(one.dm());
      const points<2> u(one.dm(), one.u());
      for (PetscInt i = own.begin; i < own.end; ++i) {
        u[i][0] = 0;
        u[i][1] = 1;
      }
    }
    const auto found = one.solve(10, 0.125).u;  // 80 steps; each damps deviations by more than half
    for (std::size_t i = 0; i < found.size(); i += 2)
      EXPECT_NEAR(found[i], (std::sqrt(5.0) - 1) / 2, 1e-7) << epsilon;  // u² = 1 - u; the tolerance of SNES
  }
}

// The options are both forms of the preconditioner, and other linear solvers and line searches.
TEST(solvers_of_stages, lead_to_the_same_solution) {
  for (const double epsilon : {1e-1, 1e-4, 1e-8}) {
    const std::string text = std::string(third_order) + " -snes_stol 1e-11";
    const auto expected = solve_exchange(text, epsilon, 64).u;
    for (const char* more :
         {" -ts_apsis_pc assembled", " -ts_apsis_pc squared -ksp_type bcgs", " -ts_apsis_curvature",
          " -ksp_type preonly -pc_type bjacobi -sub_pc_type lu", " -snes_lag_preconditioner 2",
          " -snes_linesearch_type bt -snes_max_it 60 -snes_rtol 1e-10"}) {
      if (epsilon < 1e-4 && std::string(more).find("linesearch") != std::string::npos)
        continue;  // large residuals mislead the line search
      EXPECT_LT(distance(solve_exchange(text + more, epsilon, 64).u, expected), 1e-8) << epsilon << more;
    }
  }
}

// Differences of Q have errors of about 1e-8 of Q'. The product Q̇ = Q'Q contains them.
TEST(differences_in_place_of_the_jacobian, change_the_solution_little) {
  const auto expected = solve_exchange(third_order, 1e-4, 64).u;
  for (const char* more : {" -snes_fd_color", " -snes_mf_operator", " -snes_mf"})
    EXPECT_LT(distance(solve_exchange(third_order + std::string(more), 1e-4, 64).u, expected), 1e-6) << more;
}

TEST(differences_in_place_of_the_jacobian, are_taken_without_one) {
  const options now(third_order);
  run one(line(24, 2, DM_BOUNDARY_PERIODIC));
  exchange problem{.epsilon = 1e-4};
  problem.enter(one, true, false);
  EXPECT_LT(distance(one.solve(0.25, 0.25 / 64).u, solve_exchange(third_order, 1e-4, 64).u), 1e-6);
}

// On average a Newton iteration takes two Krylov iterations, however stiff Q is. Preconditioners of an
// earlier J cost one more.
TEST(krylov_iterations, do_not_grow_with_stiffness) {
  for (const double epsilon : {1e-3, 1e-5, 1e-7, 1e-9}) {
    const auto renewed =
        solve_exchange(third_order + std::string(" -snes_lag_preconditioner 1"), epsilon, 64);
    EXPECT_LT(renewed.krylov, 3 * renewed.newton) << epsilon;
    const auto kept = solve_exchange(third_order, epsilon, 64);
    EXPECT_LT(kept.krylov, renewed.krylov + kept.newton) << epsilon;
  }
}

TEST(linear_problems, take_one_newton_iteration_a_stage) {
  const auto solve = [](const std::string& more) {
    const options now(third_order + more);
    run one(line(24, 2, DM_BOUNDARY_PERIODIC));
    exchange problem{.epsilon = 1e-6, .nonlinear = false};
    problem.enter(one);
    return one.solve(0.25, 0.25 / 64);
  };
  const auto newton = solve(" -snes_stol 1e-12"), linear = solve(" -snes_type ksponly -ksp_rtol 1e-12");
  EXPECT_EQ(linear.newton, 8 * 64);
  EXPECT_GT(newton.newton, 8 * 64);
  EXPECT_LT(distance(linear.u, newton.u), 1e-8);
}

/// Diffusion in a plane with hundreds of unknowns. 1 − γJ has algebraic multigrid as preconditioner.
PetscErrorCode diffuse(TS ts, PetscReal, Vec u, Vec rate, Vec out, void* context) {
  const double factor = *static_cast<double*>(context);
  with_ghosts(ts, u, [&](DM dm, Vec local) {
    PetscInt x = 0, y = 0, nx = 0, ny = 0;
    require(DMDAGetCorners(dm, &x, &y, nullptr, &nx, &ny, nullptr));
    PetscScalar **from = nullptr, **dot = nullptr, **to = nullptr;
    require(DMDAVecGetArray(dm, local, static_cast<void*>(&from)));
    require(DMDAVecGetArray(dm, rate, static_cast<void*>(&dot)));
    require(DMDAVecGetArray(dm, out, static_cast<void*>(&to)));
    for (PetscInt j = y; j < y + ny; ++j)
      for (PetscInt i = x; i < x + nx; ++i)
        to[j][i] = dot[j][i] - factor * (from[j][i - 1] + from[j][i + 1] + from[j - 1][i] + from[j + 1][i] -
                                         4 * from[j][i]);
    require(DMDAVecRestoreArray(dm, local, static_cast<void*>(&from)));
    require(DMDAVecRestoreArray(dm, rate, static_cast<void*>(&dot)));
    require(DMDAVecRestoreArray(dm, out, static_cast<void*>(&to)));
  });
  return 0;
}

TEST(algebraic_multigrid, preconditions_stages_of_diffusion) {
  const int n = 32;
  double factor = n * n;
  const auto solve = [&](const std::string& more) {
    const options now(third_order + more);
    DM dm = nullptr;
    require(DMDACreate2d(PETSC_COMM_WORLD, DM_BOUNDARY_PERIODIC, DM_BOUNDARY_PERIODIC, DMDA_STENCIL_STAR, n,
                         n, PETSC_DECIDE, PETSC_DECIDE, 1, 1, nullptr, nullptr, &dm));
    require(DMSetUp(dm));
    run one(dm);
    require(TSSetIFunction(one.ts(), nullptr, diffuse, &factor));
    PetscInt begin = 0, end = 0;
    require(VecGetOwnershipRange(one.u(), &begin, &end));
    for (PetscInt i = begin; i < end; ++i)
      require(VecSetValue(one.u(), i, i == 7 ? 1.0 : 0.0, INSERT_VALUES));
    require(VecAssemblyBegin(one.u()));
    require(VecAssemblyEnd(one.u()));
    return one.solve(0.1, 0.1 / 8);
  };
  const auto done = solve(" -pc_type gamg"), simple = solve(" -pc_type jacobi");
  // The fastest rate is 8192, 100 times the rate 1/Δt.
  EXPECT_LT(done.krylov, 12 * done.newton);
  EXPECT_LT(2 * done.krylov, simple.krylov);
  EXPECT_LT(distance(done.u, simple.u), 1e-7);
}

TEST(constant_jacobians, are_evaluated_once) {
  const auto solve = [](const char* more) {
    const options now(std::string(third_order) + more);
    run one(line(24, 2, DM_BOUNDARY_PERIODIC));
    exchange problem{.epsilon = 1e-4, .nonlinear = false};
    problem.enter(one);
    const auto done = one.solve(0.25, 0.25 / 64);
    return std::pair(done.u, problem.calls_of_jacobian);
  };
  const auto [expected, calls] = solve("");
  const auto [u, once] = solve(" -ts_apsis_constant_jacobian");
  EXPECT_GT(calls, 100);
  EXPECT_EQ(once, 1);
  EXPECT_LT(distance(u, expected), 1e-7);
}

}  // namespace petsc_limits
