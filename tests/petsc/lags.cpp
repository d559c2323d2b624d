#include "problems.hpp"

#include <string>
#include <utility>

#include <gmock/gmock.h>

/// Preconditioners of stages serve several stages, steps and Newton iterations.
namespace petsc_lags {

using namespace petsc_runs;

constexpr const char* eight_stages = "-ts_adapt_type none -ts_apsis_method md-imex-8-3-mixed";
constexpr const char* direct = " -ksp_type preonly -pc_type bjacobi -sub_pc_type lu";

struct counted {
  outcome result;
  int set_ups = 0;         ///< according to -ts_view
  int factorizations = 0;  ///< ILU and LU, according to PETSc
};

int factorizations() {
  int sum = 0;
  for (const char* name : {"MatILUFactorNum", "MatLUFactorNum"}) {
    PetscLogEvent event = 0;
    PetscEventPerfInfo info = {};
    require(PetscLogEventGetId(name, &event));
    if (event < 0) continue;
    require(PetscLogEventGetPerfInfo(PETSC_DETERMINE, event, &info));
    sum += info.count;
  }
  return sum;
}

/// Returns the number in the line of -ts_view.
int set_ups_in(const std::string& view) {
  const std::string line = "preconditioners of stages set up: ";
  const auto at = view.find(line);
  EXPECT_NE(at, std::string::npos) << view;
  return at == std::string::npos ? -1 : std::stoi(view.substr(at + line.size()));
}

counted solve(run& one, double end, double dt) {
  static const bool logs = [] {
    require(PetscLogDefaultBegin());
    return true;
  }();
  const int before = logs ? factorizations() : 0;
  counted out;
  out.result = one.solve(end, dt);
  out.factorizations = factorizations() - before;
  out.set_ups = set_ups_in(view_of(one.ts()));
  return out;
}

counted solve_exchange(const std::string& text, exchange problem, double end = 0.25, double dt = 0.25 / 64) {
  const options now(text);
  run one(line(24, 2, DM_BOUNDARY_PERIODIC));
  problem.enter(one);
  return solve(one, end, dt);
}

/// Reaction and diffusion are stiff parts; differences replace the Jacobian of the reaction.
counted solve_brusselator(const std::string& more) {
  const options now(eight_stages + (" -ts_apsis_fully_implicit -snes_stol 1e-11" + more));
  run one(line(39, 2, DM_BOUNDARY_NONE));
  brusselator problem;
  problem.enter(one);
  return solve(one, 1, 1.0 / 128);
}

// The eight stages have eight different √−b.
TEST(linear_problems, have_one_factorization_for_each_gamma) {
  for (const double steps : {16, 64}) {
    const double dt = 1.0 / 256;
    const exchange linear{.epsilon = 1e-2, .nonlinear = false};
    const auto iterative = solve_exchange(eight_stages, linear, steps * dt, dt);
    EXPECT_EQ(iterative.set_ups, 8);
    EXPECT_EQ(iterative.factorizations, 8);
    EXPECT_GE(iterative.result.newton, 8 * steps);
    const auto by_lu = solve_exchange(eight_stages + std::string(direct), linear, steps * dt, dt);
    EXPECT_EQ(by_lu.set_ups, 8);
    EXPECT_EQ(by_lu.factorizations, 8);
    // All stages of this method have the same a, and b = 0.
    EXPECT_EQ(solve_exchange("-ts_adapt_type none -ts_apsis_method ark-436", linear, steps * dt, dt).set_ups,
              1);
  }
}

TEST(linear_problems, factorize_again_for_another_step_length) {
  const exchange linear{.epsilon = 1e-2, .nonlinear = false};
  // The first 10 steps have the length 0.02, the last one the length 0.01.
  EXPECT_EQ(solve_exchange(eight_stages, linear, 0.21, 0.02).set_ups, 16);
}

TEST(nonlinear_problems, have_fewer_factorizations_than_newton_iterations) {
  for (const std::string more : {"", direct}) {
    const auto kept = solve_brusselator(more),
               renewed = solve_brusselator(more + " -snes_lag_preconditioner 1");
    EXPECT_EQ(kept.set_ups, kept.factorizations) << more;
    EXPECT_EQ(renewed.set_ups, renewed.result.newton) << more;
    EXPECT_LT(15 * kept.set_ups, kept.result.newton) << more;
    // The tolerance of a stage is 1e-11 times the norm of v, about 20. Errors of some stages add up.
    EXPECT_LT(distance(kept.result.u, renewed.result.u), 1e-8) << more;
    // Without a Krylov method, corrections decrease by a constant factor.
    EXPECT_LT(10 * kept.result.newton, (more.empty() ? 11 : 16) * renewed.result.newton) << more;
  }
}

// J changes by a factor of ε⁻¹ times the change of u.
TEST(nonlinear_problems, reach_the_solution_however_stiff_they_are) {
  for (const double epsilon : {1.0, 1e-2, 1e-4, 1e-6, 1e-8})
    for (const std::string more : {"", direct}) {
      const std::string text = eight_stages + (" -snes_stol 1e-11" + more);
      const auto kept = solve_exchange(text, {.epsilon = epsilon});
      const auto renewed = solve_exchange(text + " -snes_lag_preconditioner 1", {.epsilon = epsilon});
      EXPECT_LT(distance(kept.result.u, renewed.result.u), 1e-8) << epsilon << more;
      EXPECT_LE(kept.set_ups, renewed.set_ups) << epsilon << more;
      EXPECT_EQ(kept.result.rejected, 0);
    }
}

// With LU in place of a Krylov method, Newton's method with an old matrix takes more than two iterations.
TEST(stages_that_are_not_solved, are_solved_again_with_new_preconditioners) {
  const std::string text = eight_stages + std::string(direct) + " -snes_max_it 2 -ts_error_if_step_fails 0";
  const auto renewed = solve_exchange(text + " -snes_lag_preconditioner 1", {.epsilon = 1e-2});
  const auto never = solve_exchange(text + " -snes_lag_preconditioner -2", {.epsilon = 1e-2});
  const auto kept = solve_exchange(text, {.epsilon = 1e-2});
  EXPECT_EQ(never.result.reason, TS_DIVERGED_NONLINEAR_SOLVE);
  EXPECT_EQ(kept.result.reason, TS_CONVERGED_TIME);
  EXPECT_EQ(kept.result.rejected, 0);
  EXPECT_LT(2 * kept.set_ups, renewed.set_ups);
  EXPECT_LT(distance(kept.result.u, renewed.result.u), 1e-7);  // stages are solved to 1e-8
}

TEST(options_of_snes, choose_when_preconditioners_are_set_up) {
  const auto by = [](const std::string& more) {
    return solve_exchange(eight_stages + more, {.epsilon = 1e-2});
  };
  const auto each = by(" -snes_lag_preconditioner 1"), second = by(" -snes_lag_preconditioner 2"),
             never = by(" -snes_lag_preconditioner -2"), matrix = by(" -snes_lag_jacobian 2"),
             first = by(" -snes_lag_jacobian -2");
  const int stages = 8 * 64, newton = each.result.newton;
  ASSERT_GT(newton, stages);
  EXPECT_EQ(each.set_ups, newton);
  // Stages take one or two iterations. The first iteration of each has a new preconditioner.
  ASSERT_LE(newton, 2 * stages);
  for (const counted& one : {second, matrix}) {
    EXPECT_LE(one.set_ups, stages);
    EXPECT_GT(one.set_ups, stages - 8);
  }
  // One of each γ.
  for (const counted& one : {never, first}) EXPECT_EQ(one.set_ups, 8);
  for (const counted& one : {second, never, matrix, first})
    EXPECT_LT(distance(one.result.u, each.result.u), 1e-7);
}

TEST(functions_of_snes, choose_when_preconditioners_are_set_up) {
  const options now(eight_stages);
  run one(line(24, 2, DM_BOUNDARY_PERIODIC));
  exchange problem{.epsilon = 1e-2};
  problem.enter(one);
  SNES snes = nullptr;
  require(TSGetSNES(one.ts(), &snes));
  require(SNESSetLagPreconditioner(snes, 2));
  const auto done = solve(one, 0.25, 0.25 / 64);
  EXPECT_EQ(
      done.set_ups,
      solve_exchange(eight_stages + std::string(" -snes_lag_preconditioner 2"), {.epsilon = 1e-2}).set_ups);
}

/// A preconditioner of the program: ILU of the matrix, in its own object.
struct own_preconditioner {
  PC inside = nullptr;
  int set_ups = 0;

  static own_preconditioner& of(PC pc) {
    void* context = nullptr;
    require(PCShellGetContext(pc, static_cast<void*>(&context)));
    return *static_cast<own_preconditioner*>(context);
  }
  static PetscErrorCode set_up(PC pc) {
    own_preconditioner& self = of(pc);
    Mat p = nullptr;
    ++self.set_ups;
    require(PCGetOperators(pc, nullptr, &p));
    require(PCDestroy(&self.inside));
    require(PCCreate(PETSC_COMM_SELF, &self.inside));
    require(PCSetType(self.inside, PCILU));
    require(PCSetOperators(self.inside, p, p));
    return PCSetUp(self.inside);
  }
  static PetscErrorCode apply(PC pc, Vec x, Vec y) { return PCApply(of(pc).inside, x, y); }
};

// It cannot be copied for each γ.
TEST(preconditioners_of_the_program, are_set_up_for_each_gamma) {
  for (const bool nonlinear : {false, true}) {
    const options now(eight_stages);
    own_preconditioner own;
    run one(line(24, 2, DM_BOUNDARY_PERIODIC));
    exchange problem{.epsilon = 1e-2, .nonlinear = nonlinear};
    problem.enter(one);
    SNES snes = nullptr;
    KSP ksp = nullptr;
    PC pc = nullptr;
    require(TSGetSNES(one.ts(), &snes));
    require(SNESGetKSP(snes, &ksp));
    require(KSPGetPC(ksp, &pc));
    require(PCSetType(pc, PCSHELL));
    require(PCShellSetContext(pc, &own));
    require(PCShellSetSetUp(pc, own_preconditioner::set_up));
    require(PCShellSetApply(pc, own_preconditioner::apply));
    const auto done = solve(one, 0.25, 0.25 / 64);
    EXPECT_EQ(done.set_ups, own.set_ups);
    // A stage whose residual is 0 needs none.
    EXPECT_LE(own.set_ups, 8 * 64);
    EXPECT_GT(own.set_ups, 8 * 64 - 8);
    EXPECT_LT(distance(done.result.u,
                       solve_exchange(eight_stages, {.epsilon = 1e-2, .nonlinear = nonlinear}).result.u),
              1e-7);
    require(PCDestroy(&own.inside));
  }
}

}  // namespace petsc_lags
