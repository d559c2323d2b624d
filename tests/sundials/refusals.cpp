// Refused arguments and settings, with the reasons in their messages.
#include <apsis/core/errors.hpp>

#include <functional>
#include <memory>
#include <string>

#include <gtest/gtest.h>
#include <sundials/line.hpp>
#include <sundials/script.hpp>
#include <sundials/support.hpp>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunlinsol/sunlinsol_spgmr.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <support/bad_input.hpp>

namespace sundials_refusals_test {

namespace {

using namespace sundials_test;

void rethrow(int status) {
  if (status >= 0) return;
  EXPECT_EQ(status, APSIS_INPUT_ERROR);
  throw apsis::input_error(apsis_error_message());
}

}  // namespace

TEST(sundials_refusals, state_their_reason) {
  script data;
  const auto s = of_script("md-imex-6-3", data);
  const auto y = serial({1, 0});
  const auto m = find("md-imex-6-3");
  const std::unique_ptr<std::remove_pointer_t<SUNMatrix>, decltype(&SUNMatDestroy)> a(
      SUNDenseMatrix(2, 2, context()), SUNMatDestroy);
  using solver = std::unique_ptr<std::remove_pointer_t<SUNLinearSolver>, decltype(&SUNLinSolFree)>;
  const solver dense(SUNLinSol_Dense(y.get(), a.get(), context()), SUNLinSolFree);
  const solver gmres(SUNLinSol_SPGMR(y.get(), SUN_PREC_NONE, 5, context()), SUNLinSolFree);
  apsis_sundials* made = nullptr;
  const auto create = [&](const char* name, N_Vector start, double t0) {
    return [&made, name = std::string(name), start, t0] {
      rethrow(apsis_sundials_create(find(name).get(), transport, collision, t0, start, context(), &made));
    };
  };
  const auto evolve_after = [&](const std::function<int(apsis_sundials*)>& change) {
    return [&data, change] {
      const auto one = of_script("md-imex-6-3", data);
      expect_ok(change(one.get()));
      rethrow(apsis_sundials_evolve(one.get(), 1.0, nullptr, nullptr));
    };
  };
  const auto not_finite = serial({std::nan(""), 1});
  auto without_a_sum = serial({1, 0});
  without_a_sum->ops->nvlinearsum = nullptr;
  const auto longer = serial({1, 0, 0});
  const int wrong[] = {2};
  const double decreasing[] = {0.5, 0.2};
  bad_input::expect_refused(
      {{[&] { rethrow(apsis_sundials_create(nullptr, transport, collision, 0, y.get(), context(), &made)); },
        {"the method is NULL"}},
       {[&] { rethrow(apsis_sundials_create(m.get(), transport, collision, 0, y.get(), nullptr, &made)); },
        {"the context is NULL"}},
       {[&] { rethrow(apsis_sundials_create(m.get(), transport, collision, 0, nullptr, context(), &made)); },
        {"the initial state is NULL"}},
       {create("md-imex-6-3", not_finite.get(), 0.0), {"the initial state is not finite"}},
       {create("md-imex-6-3", y.get(), std::nan("")), {"the initial time is not finite"}},
       {create("md-imex-6-3", without_a_sum.get(), 0.0), {"'nvlinearsum'"}},
       {create("exponential-2", y.get(), 0.0), {"'exponential-2'", "exactly"}},
       {[&] { rethrow(apsis_sundials_set_linear_solver(s.get(), dense.get(), nullptr)); },
        {"needs a matrix"}},
       {[&] { rethrow(apsis_sundials_set_linear_solver(s.get(), gmres.get(), a.get())); }, {"iterative"}},
       {[&] { rethrow(apsis_sundials_set_linear_solver(s.get(), nullptr, a.get())); },
        {"without a linear solver"}},
       {[&] { rethrow(apsis_sundials_set_step(s.get(), -1.0)); }, {"dt is -1"}},
       {[&] { rethrow(apsis_sundials_set_first_step(s.get(), -1.0)); }, {"the first step is -1"}},
       {[&] { rethrow(apsis_sundials_set_safety(s.get(), 0.0)); }, {"safety is 0"}},
       {[&] { rethrow(apsis_sundials_set_tolerance(s.get(), -1.0, 1.0)); }, {"relative tolerance is -1"}},
       {[&] { rethrow(apsis_sundials_set_tolerance(s.get(), 1.0, 0.0)); }, {"absolute tolerance is 0"}},
       {[&] { rethrow(apsis_sundials_set_tolerances(s.get(), 1.0, serial({1, 0}).get())); },
        {"an absolute tolerance is not positive"}},
       {[&] { rethrow(apsis_sundials_set_constraints(s.get(), serial({3, 0}).get())); }, {"constraint"}},
       {[&] { rethrow(apsis_sundials_set_controller(s.get(), "pdi")); }, {"unknown controller 'pdi'"}},
       {[&] { rethrow(apsis_sundials_set_graded_start(s.get(), 1)); }, {"growth", "from 2 to 64"}},
       {[&] { rethrow(apsis_sundials_set_events(s.get(), 1, nullptr, nullptr, nullptr)); },
        {"function of events"}},
       {[&] { rethrow(apsis_sundials_set_events(s.get(), 1, mean_minus_most, wrong, nullptr)); },
        {"direction 0"}},
       {[&] { rethrow(apsis_sundials_set_stop_times(s.get(), 2, decreasing)); }, {"do not increase"}},
       {[&] { rethrow(apsis_sundials_evolve(s.get(), -1.0, nullptr, nullptr)); },
        {"end of the integration is -1"}},
       {[&] { rethrow(apsis_sundials_state_at(s.get(), 0.5, y.get())); }, {"not in the last step"}},
       {[&] { rethrow(apsis_sundials_evolve(s.get(), 1.0, longer.get(), nullptr)); },
        {"a vector has 3 elements (the state has 2)"}},
       {[&] { rethrow(apsis_sundials_one_step(s.get(), 1.0, longer.get(), nullptr)); },
        {"a vector has 3 elements"}},
       {[&] { rethrow(apsis_sundials_state_at(s.get(), 0.0, longer.get())); }, {"a vector has 3 elements"}},
       {[&] { rethrow(apsis_sundials_reset(s.get(), 0.0, longer.get())); }, {"a vector has 3 elements"}},
       {[&] { rethrow(apsis_sundials_set_constraints(s.get(), longer.get())); }, {"a vector has 3 elements"}},
       {[&] { rethrow(apsis_sundials_set_tolerances(s.get(), 1.0, longer.get())); },
        {"a vector has 3 elements"}},
       {[&] {
          size_t k = 0;
          double t = 0;
          rethrow(apsis_sundials_found_event(s.get(), 0, &k, &t));
        },
        {"there is no event 0"}},
       {evolve_after([](auto* one) { return apsis_sundials_set_step(one, 0.0); }),
        {"the step size is unknown"}},
       {evolve_after([](auto* one) {
          return apsis_sundials_set_forward_euler_step(one, line_test::forward_euler_step);
        }),
        {"dt and a forward Euler step"}},
       {evolve_after([](auto* one) { return apsis_sundials_set_graded_start(one, 4); }),
        {"no relaxation time"}},
       {evolve_after(
            [](auto* one) { return apsis_sundials_set_relaxation_time(one, line_test::forward_euler_step); }),
        {"a relaxation time", "stage solver"}},
       {evolve_after([&](auto* one) { return apsis_sundials_set_linear_solver(one, dense.get(), a.get()); }),
        {"there is no Jacobian"}},
       {evolve_after([](auto* one) {
          apsis_sundials_set_stage(one, stage);
          return apsis_sundials_set_products(one, nullptr, line_test::product);
        }),
        {"a stage solver and parts of Newton's method"}}});
  EXPECT_EQ(made, nullptr);
}

}  // namespace sundials_refusals_test
