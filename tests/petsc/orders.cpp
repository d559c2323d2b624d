#include "problems.hpp"

#include <string>

namespace petsc_orders {

using namespace petsc_runs;

/// Tolerances of stage solves that leave errors below 1e-11.
constexpr const char* accurate = " -snes_stol 1e-12 -ksp_rtol 1e-10";

std::vector<double> solve_exchange(const std::string& more, double epsilon, int steps) {
  const options now("-ts_adapt_type none" + (more + accurate));
  run one(line(24, 2, DM_BOUNDARY_PERIODIC));
  exchange problem{.epsilon = epsilon};
  problem.enter(one);
  return one.solve(0.25, 0.25 / steps).u;
}

/// Returns the order observed from errors at two numbers of steps, against a reference.
template <class Solve>
double observed_order(const Solve& solve, int steps, const std::vector<double>& reference) {
  return std::log2(distance(solve(steps), reference) / distance(solve(2 * steps), reference));
}

struct expectation {
  const char* method;
  double order;
};

class exchanges : public testing::TestWithParam<expectation> {};

// The steps resolve ε = 0.3. Another integrator of PETSc computes the reference with an error below 1e-11.
TEST_P(exchanges, of_moderate_stiffness_are_integrated_with_the_order_of_the_method) {
  static const auto reference =
      solve_exchange(" -ts_type arkimex -ts_arkimex_type 5 -snes_rtol 1e-13", 0.3, 1000);
  const auto [method, order] = GetParam();
  const auto solve = [&](int steps) {
    return solve_exchange(std::string(" -ts_apsis_method ") + method, 0.3, steps);
  };
  const double found = observed_order(solve, 32, reference);
  // Because steps are finite, the observed order may be 0.3 too low, as in other tests of orders. Some
  // methods gain an order.
  EXPECT_GT(found, order - 0.3) << method;
  EXPECT_LT(found, order + 1.2) << method;
}

INSTANTIATE_TEST_SUITE_P(methods, exchanges,
                         testing::Values(expectation{"md-imex-4-2", 2}, expectation{"md-imex-8-3-mixed", 3},
                                         expectation{"md-imex-16-4-accurate", 4}, expectation{"ark-436", 4},
                                         expectation{"ssprk-3-3", 3}, expectation{"imdrk-3-3", 3}),
                         [](const auto& one) {
                           std::string name = one.param.method;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

TEST(brusselators, are_integrated_with_order_3_where_steps_do_not_resolve_diffusion) {
  const auto solve = [](const std::string& more, int steps) {
    const options now("-ts_adapt_type none -pc_type bjacobi -sub_pc_type lu" + (more + accurate));
    run one(line(39, 2, DM_BOUNDARY_NONE));
    brusselator problem;
    problem.enter(one);
    return one.solve(1, 1.0 / steps).u;
  };
  const auto reference = solve(" -ts_type arkimex -ts_arkimex_type 5 -snes_rtol 1e-13", 1500);
  const auto by_method = [&](int steps) { return solve(" -ts_apsis_method md-imex-8-3-mixed", steps); };
  // The product of the step 1/64 and the fastest rate of diffusion, 4 · 40²/50, is 2.
  EXPECT_NEAR(observed_order(by_method, 64, reference), 3, 0.3);
}

TEST(heat_equations, are_solved_by_methods_for_stiff_parts_with_the_constant_jacobian_of_the_rhs) {
  const auto error = [](int steps) {
    const options now("-ts_adapt_type none -ts_apsis_method imdrk-3-3 -ksp_rtol 1e-12 -snes_stol 1e-12");
    run one(line(19, 1, DM_BOUNDARY_NONE));
    heat problem;
    problem.enter(one);
    const std::vector<double> initial = gathered(one.u());
    const auto done = one.solve(0.1, 0.1 / steps);
    double largest = 0;
    for (std::size_t i = 0; i < initial.size(); ++i)
      largest = std::max(largest, std::abs(done.u[i] - std::exp(problem.lambda * 0.1) * initial[i]));
    return largest;
  };
  EXPECT_NEAR(std::log2(error(4) / error(8)), 3, 0.3);
}

/// u' = λ(u − cos t) − sin t as IFunction, with the solution cos t.
PetscErrorCode follow_cosine(TS, PetscReal t, Vec u, Vec rate, Vec out, void*) {
  const double lambda = -50;
  require(VecWAXPY(out, -lambda, u, rate));
  require(VecShift(out, lambda * std::cos(t) + std::sin(t)));
  return 0;
}
PetscErrorCode derivative_of_following(TS, PetscReal, Vec, Vec, PetscReal shift, Mat, Mat p, void*) {
  require(MatZeroEntries(p));
  require(MatShift(p, shift + 50));
  return 0;
}

// Without ∂Q/∂t in the stages the order would be 1.
TEST(methods_for_stiff_parts, have_their_order_if_the_stiff_part_depends_on_time) {
  const auto error = [](int steps) {
    const options now("-ts_adapt_type none -ts_apsis_method imdrk-3-3 -snes_stol 1e-13");
    run one(line(4, 1, DM_BOUNDARY_NONE));
    require(TSSetIFunction(one.ts(), nullptr, follow_cosine, nullptr));
    require(TSSetIJacobian(one.ts(), nullptr, nullptr, derivative_of_following, nullptr));
    require(VecSet(one.u(), 1));
    return std::abs(one.solve(1, 1.0 / steps).u[0] - std::cos(1.0));
  };
  EXPECT_GT(std::log2(error(40) / error(80)), 2.7);
}

// Implicit-explicit methods integrate time with T.
TEST(implicit_explicit_methods, have_their_order_if_the_stiff_part_depends_on_time) {
  const auto error = [](int steps) {
    const options now("-ts_adapt_type none -ts_apsis_method md-imex-8-3-mixed -snes_stol 1e-13");
    run one(line(4, 1, DM_BOUNDARY_NONE));
    require(TSSetIFunction(one.ts(), nullptr, follow_cosine, nullptr));
    require(TSSetIJacobian(one.ts(), nullptr, nullptr, derivative_of_following, nullptr));
    require(VecSet(one.u(), 1));
    return std::abs(one.solve(1, 1.0 / steps).u[0] - std::cos(1.0));
  };
  EXPECT_GT(std::log2(error(160) / error(320)), 2.7);
}

}  // namespace petsc_orders
