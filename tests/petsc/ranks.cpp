#include "problems.hpp"

#include <string>

/// Runs on all processes with few steps, because a busy machine takes milliseconds for each
/// sum over processes.
namespace petsc_ranks {

using namespace petsc_runs;

outcome solve_exchange(const std::string& text, double epsilon, int steps) {
  const options now("-snes_stol 1e-12 -ksp_rtol 1e-10 " + text);
  run one(line(12, 2, DM_BOUNDARY_PERIODIC));
  exchange problem{.epsilon = epsilon};
  problem.enter(one);
  return one.solve(0.25, 0.25 / steps);
}

// Sums over processes have different rounding errors, and block Jacobi has different blocks.
TEST(ranks, leave_the_solution_to_the_tolerance_of_stage_solves) {
  struct {
    double epsilon;
    const char* options;
  } const all[] = {{1e-9, "-ts_adapt_type none"},
                   {1e-2, "-ts_adapt_type basic -ts_rtol 1e-3 -ts_atol 1e-3"},
                   {1e-2, "-ts_adapt_type none -ts_exact_final_time interpolate -ts_dt 0.07"},
                   {1e-4, "-ts_adapt_type none -snes_fd_color"},
                   {1e-4, "-ts_adapt_type none -ts_apsis_pc assembled -pc_type bjacobi -sub_pc_type lu"}};
  for (const auto& [epsilon, text] : all) {
    const auto together = solve_exchange(text, epsilon, 4);
    const auto single = alone([&, e = epsilon, o = std::string(text)] { return solve_exchange(o, e, 4); });
    EXPECT_LT(distance(together.u, single.u), 1e-8) << epsilon << " " << text;
    EXPECT_EQ(together.steps, single.steps) << text;
    EXPECT_DOUBLE_EQ(together.t, single.t) << text;
  }
}

TEST(ranks, solve_diffusion_with_neighbours_on_other_processes) {
  const auto solve = [] {
    const options now("-ts_adapt_type none -snes_stol 1e-11 -ksp_rtol 1e-8");
    run one(line(20, 2, DM_BOUNDARY_NONE));
    brusselator problem;
    problem.enter(one);
    return one.solve(0.5, 0.1).u;
  };
  EXPECT_LT(distance(solve(), alone(solve)), 1e-8);
}

TEST(ranks, agree_on_steps_that_a_process_rejects) {
  const options now("-ts_adapt_type none -ts_max_steps 1");
  run one(line(12, 2, DM_BOUNDARY_PERIODIC));
  exchange problem;
  problem.enter(one);
  int calls = 0;
  require(TSSetApplicationContext(one.ts(), &calls));
  require(
      TSSetFunctionDomainError(one.ts(), [](TS ts, PetscReal, Vec, PetscBool* accepted) -> PetscErrorCode {
        void* context = nullptr;
        require(TSGetApplicationContext(ts, static_cast<void*>(&context)));
        *accepted = ++*static_cast<int*>(context) > 1 ? PETSC_TRUE : PETSC_FALSE;
        return 0;
      }));
  require(TSSetExactFinalTime(one.ts(), TS_EXACTFINALTIME_STEPOVER));
  const auto done = one.solve(1, 0.04);
  EXPECT_EQ(done.rejected, 1);
  EXPECT_NEAR(done.t, 0.01, 1e-15);
}

}  // namespace petsc_ranks
