#include "problems.hpp"

#include <functional>
#include <string>

#include <gmock/gmock.h>

namespace petsc_refusals {

using namespace petsc_runs;
using testing::HasSubstr;

/// Returns the message with which TSSolve() fails for a TS that `change` prepares, or "" if it succeeds.
std::string refusal(const std::string& text, const std::function<void(run&, exchange&)>& change) {
  const options now(text);
  run one(line(24, 2, DM_BOUNDARY_PERIODIC));
  exchange problem;
  problem.enter(one);
  change(one, problem);
  require(TSSetMaxTime(one.ts(), 1));
  require(TSSetTimeStep(one.ts(), 0.01));
  const error_messages messages;
  if (TSSetFromOptions(one.ts()) == 0) static_cast<void>(TSSolve(one.ts(), one.u()));
  return messages.first();
}

TEST(refusals, name_the_row_of_a_mass_matrix) {
  const auto twice = [](TS ts, PetscReal t, Vec u, Vec rate, Vec out, void* context) -> PetscErrorCode {
    require(exchange::collision(ts, t, u, rate, out, context));
    PetscInt begin = 0, end = 0;
    require(VecGetOwnershipRange(rate, &begin, &end));
    if (begin <= 5 && 5 < end) {
      const PetscScalar* dot = nullptr;
      require(VecGetArrayRead(rate, &dot));
      const double more = dot[5 - begin];
      require(VecRestoreArrayRead(rate, &dot));
      require(VecSetValue(out, 5, more, ADD_VALUES));
    }
    require(VecAssemblyBegin(out));
    require(VecAssemblyEnd(out));
    return 0;
  };
  const auto message = refusal(
      "", [&](run& one, exchange& problem) { require(TSSetIFunction(one.ts(), nullptr, twice, &problem)); });
  EXPECT_THAT(message, HasSubstr("needs F(t, u, u') = u' - Q(t, u) (row 5 of the IFunction"));
}

TEST(refusals, name_the_row_of_an_algebraic_equation) {
  const auto algebraic = [](TS ts, PetscReal t, Vec u, Vec rate, Vec out, void* context) -> PetscErrorCode {
    require(exchange::collision(ts, t, u, rate, out, context));
    PetscInt begin = 0, end = 0;
    require(VecGetOwnershipRange(rate, &begin, &end));
    PetscScalar* to = nullptr;
    require(VecGetArray(out, &to));
    if (begin == 0) to[0] = 1;
    require(VecRestoreArray(out, &to));
    return 0;
  };
  const auto message = refusal("", [&](run& one, exchange& problem) {
    require(TSSetIFunction(one.ts(), nullptr, algebraic, &problem));
  });
  EXPECT_THAT(message, HasSubstr("(row 0 of the IFunction"));
}

TEST(refusals, concern_declared_daes) {
  for (const TSEquationType type : {TS_EQ_DAE_IMPLICIT_INDEX1, TS_EQ_DAE_SEMI_EXPLICIT_INDEX1})
    EXPECT_THAT(refusal("", [type](run& one, exchange&) { require(TSSetEquationType(one.ts(), type)); }),
                HasSubstr("cannot integrate a DAE (TSSetEquationType() declares one)"));
  EXPECT_EQ(refusal("-ts_max_steps 1",
                    [](run& one, exchange&) { require(TSSetEquationType(one.ts(), TS_EQ_ODE_IMPLICIT)); }),
            "");
}

/// Returns the message with which TSApsisSetMethod() fails.
std::string refusal_of_method(const char* name) {
  run one(line(24, 2, DM_BOUNDARY_PERIODIC));
  const error_messages messages;
  EXPECT_EQ(TSApsisSetMethod(one.ts(), name), PETSC_ERR_ARG_WRONG);
  return messages.first();
}

TEST(refusals, of_unknown_methods_name_the_nearest) {
  EXPECT_THAT(refusal_of_method("md-imex-8-3-mixd"), HasSubstr("'md-imex-8-3-mixed'"));
}

TEST(refusals, concern_methods_of_other_kinds) {
  EXPECT_THAT(refusal_of_method("imex-bdf-3"),
              HasSubstr("(it needs 3 equal steps, which PETSc does not promise)"));
  EXPECT_THAT(refusal_of_method("exponential-2"), HasSubstr("(it solves collisions exactly)"));
}

TEST(refusals, concern_step_limits_without_an_ssp_coefficient) {
  EXPECT_THAT(refusal("-ts_apsis_method ark-436 -ts_apsis_ssp_step 0.1", [](run&, exchange&) {}),
              HasSubstr("its SSP coefficient is 0"));
  EXPECT_THAT(refusal("-ts_apsis_ssp_step -1", [](run&, exchange&) {}),
              HasSubstr("-ts_apsis_ssp_step is -1"));
}

TEST(refusals, concern_steps_of_the_program_that_are_not_positive) {
  const auto zero = [](TS, PetscReal, Vec, PetscReal* dt, void*) -> PetscErrorCode {
    *dt = 0;
    return 0;
  };
  EXPECT_THAT(
      refusal("", [&](run& one, exchange&) { require(TSApsisSetForwardEulerStep(one.ts(), zero, nullptr)); }),
      HasSubstr("the forward Euler step of the program is 0"));
}

TEST(errors_of_the_program, pass_through_with_their_codes) {
  const options now("-ts_adapt_type none");
  run one(line(24, 2, DM_BOUNDARY_PERIODIC));
  exchange problem;
  problem.enter(one);
  const auto failing = [](TS, PetscReal, Vec, Vec, void*) -> PetscErrorCode {
    return PetscError(PETSC_COMM_SELF, __LINE__, "failing", __FILE__, PETSC_ERR_USER, PETSC_ERROR_INITIAL,
                      "no data");
  };
  require(TSSetRHSFunction(one.ts(), nullptr, failing, nullptr));
  require(TSSetMaxTime(one.ts(), 1));
  require(TSSetTimeStep(one.ts(), 0.01));
  const error_messages messages;
  EXPECT_EQ(TSSolve(one.ts(), one.u()), PETSC_ERR_USER);
  EXPECT_EQ(messages.first(), "no data");
}

TEST(methods, are_set_and_read_by_functions) {
  run one(line(24, 2, DM_BOUNDARY_PERIODIC));
  const char* name = nullptr;
  require(TSApsisSetMethod(one.ts(), "md-imex-chain-5-2"));
  require(TSApsisGetMethod(one.ts(), &name));
  EXPECT_STREQ(name, "md-imex-chain-5-2");
  require(TSSetType(one.ts(), TSARKIMEX));
  require(TSApsisSetMethod(one.ts(), "ignored by other types"));
  const error_messages messages;
  EXPECT_EQ(TSApsisGetMethod(one.ts(), &name), PETSC_ERR_ARG_WRONG);
  EXPECT_THAT(messages.first(), HasSubstr("its type is not 'apsis'"));
}

// After the run, its SNES has the matrices, the convergence test and the preconditioner of the program again.
TEST(other_types, continue_a_run) {
  const options now("-ts_adapt_type none");
  run one(line(24, 2, DM_BOUNDARY_PERIODIC));
  exchange problem;
  problem.enter(one);
  one.solve(0.1, 0.01);
  require(TSSetType(one.ts(), TSARKIMEX));
  require(TSSetMaxSteps(one.ts(), 1000));
  const auto done = one.solve(0.2, 0.01);
  EXPECT_EQ(done.reason, TS_CONVERGED_TIME);
  run other(line(24, 2, DM_BOUNDARY_PERIODIC));
  problem.enter(other);
  EXPECT_LT(distance(other.solve(0.2, 0.01).u, done.u), 1e-3);  // both have errors of 1e-4
}

}  // namespace petsc_refusals
