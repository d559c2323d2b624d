#include "problems.hpp"

#include <string>

namespace petsc_steps {

using namespace petsc_runs;

std::vector<double> reference(double epsilon, double end) {
  const options now("-ts_type arkimex -ts_arkimex_type 5 -ts_adapt_type none -snes_rtol 1e-13");
  run one(line(24, 2, DM_BOUNDARY_PERIODIC));
  exchange problem{.epsilon = epsilon};
  problem.enter(one, false);
  return one.solve(end, 1e-4).u;
}

TEST(adaptive_steps, reach_the_tolerance) {
  const auto expected = reference(0.01, 0.25);
  for (const char* method : {"md-imex-8-3-mixed", "ark-436", "md-imex-4-2"}) {
    int before = 0;
    for (const double tolerance : {1e-4, 1e-6}) {
      const options now("-ts_adapt_type basic -snes_stol 1e-10 -ts_apsis_method " + std::string(method) +
                        " -ts_rtol " + std::to_string(tolerance) + " -ts_atol " + std::to_string(tolerance));
      run one(line(24, 2, DM_BOUNDARY_PERIODIC));
      exchange problem{.epsilon = 0.01};
      problem.enter(one, false);
      // The first step is much too long for the tolerance.
      const auto done = one.solve(0.25, 0.05);
      EXPECT_EQ(done.reason, TS_CONVERGED_TIME);
      EXPECT_DOUBLE_EQ(done.t, 0.25);
      EXPECT_GT(done.rejected, 0) << method;
      // Errors of steps add up to less than 20 tolerances.
      EXPECT_LT(distance(done.u, expected), 20 * tolerance) << method;
      EXPECT_GT(done.steps, before) << method;
      before = done.steps;
    }
  }
}

TEST(rejected_steps, leave_no_trace) {
  // A rejected step must give the bits of the shorter step.
  const auto solve = [](const std::string& more, double dt) {
    const options now("-ts_max_steps 1 -ts_exact_final_time stepover" + more);
    run one(line(24, 2, DM_BOUNDARY_PERIODIC));
    exchange problem{.epsilon = 0.01};
    problem.enter(one, false);
    return one.solve(1, dt);
  };
  const auto repeated = solve(" -ts_adapt_type basic -ts_rtol 1e-5 -ts_atol 1e-5 -ts_adapt_clip 0.5,2", 0.04);
  ASSERT_GT(repeated.rejected, 0);
  const auto direct = solve(" -ts_adapt_type basic -ts_rtol 1e-5 -ts_atol 1e-5", repeated.t);
  EXPECT_EQ(direct.rejected, 0);
  // The step lengths agree to rounding.
  EXPECT_LT(distance(repeated.u, direct.u), 1e-9);
}

TEST(interpolation, has_the_order_of_the_method_and_the_ends_of_the_step) {
  const auto error = [](double dt, double share) {
    const options now("-ts_adapt_type none -ts_max_steps 1 -snes_stol 1e-13 -ksp_rtol 1e-10");
    const auto at = [&](double end) {
      const options fine("-ts_type arkimex -ts_arkimex_type 5 -ts_adapt_type none -snes_rtol 1e-13");
      run one(line(24, 2, DM_BOUNDARY_PERIODIC));
      exchange problem{.epsilon = 0.3};
      problem.enter(one);
      return one.solve(end, end / 50).u;
    };
    run one(line(24, 2, DM_BOUNDARY_PERIODIC));
    exchange problem{.epsilon = 0.3};
    problem.enter(one);
    require(TSSetExactFinalTime(one.ts(), TS_EXACTFINALTIME_STEPOVER));
    one.solve(1, dt);
    Vec inside = nullptr;
    require(VecDuplicate(one.u(), &inside));
    require(TSInterpolate(one.ts(), share * dt, inside));
    const auto found = gathered(inside);
    require(VecDestroy(&inside));
    return distance(found, share == 1 ? gathered(one.u()) : at(share * dt));
  };
  EXPECT_EQ(error(0.02, 1), 0);
  // One step of a method of order 3 has an error of order 4.
  EXPECT_GT(std::log2(error(0.02, 0.5) / error(0.01, 0.5)), 3.6);
}

TEST(interpolation, gives_the_solution_at_the_final_time) {
  const options now("-ts_adapt_type none -ts_exact_final_time interpolate -snes_stol 1e-12");
  run one(line(24, 2, DM_BOUNDARY_PERIODIC));
  exchange problem{.epsilon = 0.01};
  problem.enter(one, false);
  const auto done = one.solve(0.25, 0.25 / 64.5);  // the last step ends later
  EXPECT_DOUBLE_EQ(done.t, 0.25);
  EXPECT_LT(distance(done.u, reference(0.01, 0.25)), 1e-3);
}

/// Finds the time of the event u_0 = 0.9, and counts events.
struct crossing {
  double t = 0;
  int count = 0;
};
PetscErrorCode distance_to_crossing(TS, PetscReal, Vec u, PetscScalar* value, void*) {
  value[0] = gathered(u)[0] - 0.9;
  return 0;
}
PetscErrorCode note_crossing(TS ts, PetscInt, PetscInt*, PetscReal t, Vec, PetscBool, void*) {
  void* context = nullptr;
  require(TSGetApplicationContext(ts, static_cast<void*>(&context)));
  auto& found = *static_cast<crossing*>(context);
  found.t = t;
  ++found.count;
  return 0;
}

TEST(events, are_located) {
  const auto locate = [](const std::string& text, double dt) {
    const options now(text);
    run one(line(24, 2, DM_BOUNDARY_PERIODIC));
    exchange problem{.epsilon = 0.01};
    problem.enter(one);
    crossing found;
    PetscInt direction = 0;
    PetscBool ends = PETSC_TRUE;
    require(TSSetApplicationContext(one.ts(), &found));
    require(TSSetEventHandler(one.ts(), 1, &direction, &ends, distance_to_crossing, note_crossing, nullptr));
    require(TSSetEventTolerances(one.ts(), 1e-10, nullptr));
    one.solve(1, dt);
    EXPECT_EQ(found.count, 1);
    return found.t;
  };
  const double t = locate("-ts_adapt_type none -snes_stol 1e-12", 1.0 / 512);
  const double expected =
      locate("-ts_type arkimex -ts_arkimex_type 5 -ts_adapt_type none -snes_rtol 1e-13", 1.0 / 1024);
  EXPECT_GT(t, 0.0);
  // The tolerance covers the error of 512 steps.
  EXPECT_NEAR(t, expected, 1e-4);
}

TEST(roll_back, restores_the_state_before_the_step) {
  const options now("-ts_adapt_type none -ts_max_steps 3");
  run one(line(24, 2, DM_BOUNDARY_PERIODIC));
  exchange problem{.epsilon = 0.01};
  problem.enter(one);
  one.solve(1, 0.01);
  const auto third = gathered(one.u());
  require(TSRollBack(one.ts()));
  EXPECT_GT(distance(gathered(one.u()), third), 1e-4);
  PetscReal t = 0;
  require(TSGetTime(one.ts(), &t));
  EXPECT_NEAR(t, 0.02, 1e-15);
  require(TSStep(one.ts()));
  EXPECT_LT(distance(gathered(one.u()), third), 1e-10);
}

TEST(reset, lets_a_run_begin_anew_with_another_number_of_points) {
  const options now("-ts_adapt_type none");
  exchange problem{.epsilon = 0.01};
  const auto solve = [&](run& one) {
    problem.enter(one);
    return one.solve(0.1, 0.01);
  };
  run few(line(24, 2, DM_BOUNDARY_PERIODIC)), many(line(30, 2, DM_BOUNDARY_PERIODIC));
  solve(few);
  const auto expected = solve(many);
  // The first TS gets a DM like that of the second.
  DM dm = line(30, 2, DM_BOUNDARY_PERIODIC);
  require(TSReset(few.ts()));
  require(TSSetDM(few.ts(), dm));
  require(DMDestroy(&dm));
  require(TSSetTime(few.ts(), 0));
  require(TSSetStepNumber(few.ts(), 0));
  require(TSSetTimeStep(few.ts(), 0.01));
  problem.enter(many);  // sets the initial values again
  require(TSSolve(few.ts(), many.u()));
  EXPECT_LT(distance(gathered(many.u()), expected.u), 1e-12);
}

/// Rejects states with an entry above the limit, as a problem that is undefined there would.
PetscErrorCode limit_states(TS, PetscReal, Vec u, PetscBool* accepted) {
  PetscReal largest = 0;
  require(VecMax(u, nullptr, &largest));
  *accepted = largest < 2.5 ? PETSC_TRUE : PETSC_FALSE;
  return 0;
}

TEST(stages_outside_the_domain, repeat_the_step_with_another_length) {
  const options now("-ts_adapt_type none -ts_max_steps 1 -ts_max_snes_failures -1");
  run one(line(24, 2, DM_BOUNDARY_PERIODIC));
  exchange problem{.epsilon = 0.01};
  problem.enter(one);
  require(TSSetFunctionDomainError(one.ts(), limit_states));
  require(TSSetExactFinalTime(one.ts(), TS_EXACTFINALTIME_STEPOVER));
  const auto done = one.solve(10, 2.0);
  EXPECT_GT(done.rejected, 0);
  EXPECT_LT(done.t, 2.0);
  EXPECT_EQ(done.steps, 1);
}

TEST(stages_outside_the_domain, end_the_run_after_the_allowed_number_of_rejections) {
  const options now("-ts_adapt_type none -ts_max_reject 3 -ts_error_if_step_fails 0");
  run one(line(24, 2, DM_BOUNDARY_PERIODIC));
  exchange problem{.epsilon = 0.01};
  problem.enter(one);
  require(TSSetFunctionDomainError(one.ts(), [](TS, PetscReal, Vec, PetscBool* accepted) -> PetscErrorCode {
    *accepted = PETSC_FALSE;
    return 0;
  }));
  const auto before = gathered(one.u());
  const auto done = one.solve(1, 0.1);
  EXPECT_EQ(done.reason, TS_DIVERGED_STEP_REJECTED);
  EXPECT_EQ(done.steps, 0);
  EXPECT_EQ(distance(done.u, before), 0);
}

/// Upwind advection of a block, with decay u' = −u/ε as the stiff part.
struct decay {
  double epsilon = 1e-4;
  static PetscErrorCode transport(TS ts, PetscReal, Vec u, Vec out, void*) {
    with_ghosts(ts, u, [out](DM dm, Vec local) {
      const own_points own(dm);
      const points<1> from(dm, local), to(dm, out);
      for (PetscInt i = own.begin; i < own.end; ++i)
        to[i][0] = -static_cast<double>(own.all) * (from[i][0] - from[i - 1][0]);
    });
    return 0;
  }
  static PetscErrorCode collision(TS, PetscReal, Vec u, Vec rate, Vec out, void* context) {
    require(VecWAXPY(out, 1 / static_cast<decay*>(context)->epsilon, u, rate));
    return 0;
  }
  static PetscErrorCode jacobian(TS, PetscReal, Vec, Vec, PetscReal shift, Mat, Mat p, void* context) {
    require(MatZeroEntries(p));
    require(MatShift(p, shift + 1 / static_cast<decay*>(context)->epsilon));
    return 0;
  }
};

/// Returns the smallest entry after some steps.
double smallest_entry(const std::string& text, double dt, double epsilon = 10,
                      TSApsisForwardEulerStep* function = nullptr, int* steps = nullptr) {
  const options now("-ts_adapt_type none -ksp_rtol 1e-14 -snes_stol 1e-14 " + text);
  run one(line(40, 1, DM_BOUNDARY_PERIODIC));
  decay problem{.epsilon = epsilon};
  require(TSSetRHSFunction(one.ts(), nullptr, decay::transport, nullptr));
  require(TSSetIFunction(one.ts(), nullptr, decay::collision, &problem));
  require(TSSetIJacobian(one.ts(), nullptr, nullptr, decay::jacobian, &problem));
  require(TSApsisSetForwardEulerStep(one.ts(), function, nullptr));
  {
    const own_points own(one.dm());
    const points<1> u(one.dm(), one.u());
    for (PetscInt i = own.begin; i < own.end; ++i) u[i][0] = i < 10 ? 1 : 0;
  }
  const auto done = one.solve(0.5, dt);
  if (steps != nullptr) *steps = done.steps;
  return *std::min_element(done.u.begin(), done.u.end());
}

// Forward Euler steps of upwind differences are positive up to Δt_FE = 1/40. The method has r = 1.25.
TEST(positivity, holds_up_to_r_forward_euler_steps_and_not_far_above) {
  for (const double epsilon : {10.0, 0.1, 1e-4, 1e-8})
    EXPECT_GE(smallest_entry("", 1.25 / 40, epsilon), -1e-15) << epsilon;
  EXPECT_LT(smallest_entry("", 2.5 / 40), -1e-3);
}

TEST(positivity, holds_for_longer_steps_if_the_forward_euler_step_limits_them) {
  int steps = 0;
  EXPECT_GE(smallest_entry("-ts_apsis_ssp_step 0.025", 0.25, 10, nullptr, &steps), -1e-15);
  EXPECT_EQ(steps, 16);  // 0.5 / (1.25 · 0.025)
  const auto of_program = [](TS, PetscReal, Vec, PetscReal* dt, void*) -> PetscErrorCode {
    *dt = 0.025;
    return 0;
  };
  EXPECT_GE(smallest_entry("", 0.25, 10, of_program, &steps), -1e-15);
  EXPECT_EQ(steps, 16);
}

}  // namespace petsc_steps
