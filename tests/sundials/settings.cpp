// Events, dense output, stops, observers, and callbacks that fail.
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <sundials/line.hpp>
#include <sundials/script.hpp>
#include <sundials/support.hpp>

namespace sundials_settings_test {

using namespace sundials_test;

TEST(sundials_settings, find_events_and_end_at_them) {
  script data;
  auto s = of_script("ark-436", data);
  const int directions[] = {1, 0}, ends[] = {1, 0};
  expect_ok(apsis_sundials_set_events(s.get(), 2, mean_minus_most, directions, ends));
  const auto y = serial({0, 0});
  double reached = 0;
  EXPECT_EQ(apsis_sundials_evolve(s.get(), 1.0, y.get(), &reached), APSIS_EVENT);
  // The solution has an error of fourth order in 1/64.
  EXPECT_NEAR(reached, std::asin(0.6), 1e-8);
  EXPECT_NEAR((values(y.get())[0] + values(y.get())[1]) / 2, 0.8, 1e-14);
  const auto events = static_cast<std::size_t>(apsis_sundials_count(s.get(), APSIS_SUNDIALS_EVENTS));
  ASSERT_EQ(events, 5U);  // one end and four multiples of π/20 before 0.6435
  for (std::size_t i = 0; i < 4; ++i) {
    std::size_t k = 9;
    double t = 0;
    expect_ok(apsis_sundials_found_event(s.get(), i, &k, &t));
    EXPECT_EQ(k, 1U);
    EXPECT_NEAR(t, M_PI / 20 * static_cast<double>(i + 1), 1e-14);
  }
  expect_ok(apsis_sundials_set_events(s.get(), 0, nullptr, nullptr, nullptr));
  expect_ok(apsis_sundials_evolve(s.get(), 1.0, y.get(), &reached));
  EXPECT_EQ(reached, 1.0);
  EXPECT_EQ(apsis_sundials_count(s.get(), APSIS_SUNDIALS_EVENTS), 5);
}

TEST(sundials_settings, give_dense_output_of_the_order_of_the_method) {
  const auto error_at_middle = [](int steps) {
    script data;
    auto s = of_script("ark-436", data);
    expect_ok(apsis_sundials_set_step(s.get(), 1.0 / steps));
    expect_ok(apsis_sundials_evolve(s.get(), 1.0, nullptr, nullptr));
    const auto y = serial({0, 0});
    const double t = 1.0 - 0.6 / steps;
    expect_ok(apsis_sundials_state_at(s.get(), t, y.get()));
    return std::abs((values(y.get())[0] + values(y.get())[1]) - 1.0 - std::sin(t));
  };
  EXPECT_GT(std::log2(error_at_middle(8) / error_at_middle(16)), 3.7);
}

TEST(sundials_settings, call_the_observer_which_may_look_back_and_end) {
  script data;
  auto s = of_script("md-imex-6-3", data);
  data.called = s.get();
  expect_ok(
      apsis_sundials_set_observer(s.get(), [](long long step, double t, double dt, N_Vector y, void* of) {
        auto& now = *static_cast<script*>(of);
        EXPECT_EQ(t, static_cast<double>(step) / 64);
        EXPECT_EQ(dt, 1.0 / 64);
        now.seen.push_back(N_VGetArrayPointer(y)[0]);
        const auto at = serial({0, 0});
        now.statuses.push_back(apsis_sundials_state_at(now.called, t, at.get()));
        EXPECT_EQ(values(at.get()), values(y));
        now.statuses.push_back(apsis_sundials_set_step(now.called, 1.0));
        now.statuses.push_back(apsis_sundials_evolve(now.called, 2.0, nullptr, nullptr));
        return step == 5 ? 1 : 0;
      }));
  const auto y = serial({0, 0});
  double reached = 0;
  EXPECT_EQ(apsis_sundials_evolve(s.get(), 1.0, y.get(), &reached), APSIS_STOPPED);
  EXPECT_EQ(reached, 5.0 / 64);
  ASSERT_EQ(data.seen.size(), 5U);
  EXPECT_EQ(data.seen.back(), values(y.get())[0]);
  for (std::size_t i = 0; i < data.statuses.size(); ++i)
    EXPECT_EQ(data.statuses[i], i % 3 == 0 ? APSIS_OK : APSIS_INPUT_ERROR);
}

TEST(sundials_settings, give_dense_output_to_the_thread_of_the_observer_alone) {
  script data;
  auto s = of_script("md-imex-6-3", data);
  data.called = s.get();
  expect_ok(apsis_sundials_set_observer(s.get(), [](long long, double t, double, N_Vector, void* of) {
    auto& now = *static_cast<script*>(of);
    const auto at = serial({0, 0});
    std::thread([&] {
      now.statuses.push_back(apsis_sundials_state_at(now.called, t, at.get()));
      EXPECT_EQ(std::string(apsis_error_message()).find("the integrator is in use"), 0U)
          << apsis_error_message();
    }).join();
    now.statuses.push_back(apsis_sundials_state_at(now.called, t, at.get()));
    return 0;
  }));
  expect_ok(apsis_sundials_evolve(s.get(), 1.0 / 32, nullptr, nullptr));
  EXPECT_EQ(data.statuses, (std::vector<int>{APSIS_INPUT_ERROR, APSIS_OK, APSIS_INPUT_ERROR, APSIS_OK}));
}

TEST(sundials_settings, refuse_callbacks_after_an_observer_that_throws) {
  struct asking : script {
    bool throws = true;
  } data;
  const auto asking_transport = [](double t, N_Vector y, N_Vector out, void* of) {
    auto& now = *static_cast<asking*>(of);
    const auto at = serial({0, 0});
    if (!now.throws) now.statuses.push_back(apsis_sundials_state_at(now.called, t, at.get()));
    return transport(t, y, out, static_cast<script*>(&now));
  };
  auto s = make("md-imex-6-3", asking_transport, nullptr, 0.0, serial({1, 0}).get(), &data);
  data.called = s.get();
  expect_ok(apsis_sundials_set_step(s.get(), 1.0 / 64));
  expect_ok(apsis_sundials_set_observer(s.get(), [](long long, double, double, N_Vector, void* of) {
    if (static_cast<asking*>(of)->throws) throw std::runtime_error("the observer throws");
    return 0;
  }));
  EXPECT_EQ(apsis_sundials_evolve(s.get(), 1.0 / 32, nullptr, nullptr), APSIS_INTERNAL_ERROR);
  EXPECT_EQ(std::string(apsis_error_message()), "the observer throws");
  data.throws = false;
  expect_ok(apsis_sundials_evolve(s.get(), 1.0 / 16, nullptr, nullptr));
  ASSERT_FALSE(data.statuses.empty());
  for (const int status : data.statuses) EXPECT_EQ(status, APSIS_INPUT_ERROR);
}

TEST(sundials_settings, end_steps_at_stop_times_and_continue_with_other_settings) {
  script data;
  auto s = of_script("md-imex-6-3", data);
  const double stops[] = {0.3, 0.7};
  expect_ok(apsis_sundials_set_stop_times(s.get(), 2, stops));
  expect_ok(apsis_sundials_set_observer(s.get(), [](long long, double t, double, N_Vector, void* of) {
    static_cast<script*>(of)->seen.push_back(t);
    return 0;
  }));
  expect_ok(apsis_sundials_evolve(s.get(), 0.5, nullptr, nullptr));
  expect_ok(apsis_sundials_set_step(s.get(), 1.0 / 32));
  expect_ok(apsis_sundials_evolve(s.get(), 1.0, nullptr, nullptr));
  for (const double stop : stops) EXPECT_EQ(std::count(data.seen.begin(), data.seen.end(), stop), 1) << stop;
  EXPECT_EQ(apsis_sundials_count(s.get(), APSIS_SUNDIALS_STEPS), static_cast<long long>(data.seen.size()));
  expect_ok(apsis_sundials_reset(s.get(), 0.0, serial({1, 0}).get()));
  EXPECT_EQ(apsis_sundials_time(s.get()), 0.0);
  EXPECT_EQ(apsis_sundials_count(s.get(), APSIS_SUNDIALS_STEPS), 0);
}

TEST(sundials_settings, take_one_step_after_the_other) {
  script data;
  auto s = of_script("md-imex-6-3", data), whole = of_script("md-imex-6-3", data);
  expect_ok(apsis_sundials_set_step(s.get(), 0.3));
  expect_ok(apsis_sundials_set_step(whole.get(), 0.3));
  const auto y = serial({0, 0}), other = serial({0, 0});
  double reached = 0;
  // The remaining interval is divided into equal steps anew: 1/4 of 1, then 1/3 of 3/4.
  for (int k = 1; k <= 4; ++k) {
    expect_ok(apsis_sundials_one_step(s.get(), 1.0, y.get(), &reached));
    EXPECT_EQ(reached, 0.25 * k);
  }
  expect_ok(apsis_sundials_evolve(whole.get(), 1.0, other.get(), nullptr));
  EXPECT_EQ(values(y.get()), values(other.get()));
  EXPECT_EQ(apsis_sundials_count(s.get(), APSIS_SUNDIALS_STEPS), 4);
}

#ifdef APSIS_SUNDIALS_HAS_STEPPERS
TEST(sundials_settings, are_those_of_a_stepper_of_sundials) {
  script data;
  auto s = of_script("md-imex-6-3", data);
  SUNStepper stepper = nullptr;
  expect_ok(apsis_sundials_make_stepper(s.get(), &stepper));
  const auto y = serial({0, 0}), rate = serial({0, 0});
  double reached = 0;
  EXPECT_EQ(SUNStepper_OneStep(stepper, 1.0, y.get(), &reached), SUN_SUCCESS);
  EXPECT_EQ(reached, 1.0 / 64);
  EXPECT_EQ(SUNStepper_Evolve(stepper, 1.0, y.get(), &reached), SUN_SUCCESS);
  EXPECT_EQ(reached, 1.0);
  suncountertype steps = 0;
  EXPECT_EQ(SUNStepper_GetNumSteps(stepper, &steps), SUN_SUCCESS);
  EXPECT_EQ(steps, 64);
  EXPECT_EQ(SUNStepper_FullRhs(stepper, 0.0, serial({1, 0}).get(), rate.get(), SUN_FULLRHS_OTHER),
            SUN_SUCCESS);
  EXPECT_EQ(values(rate.get()), (std::vector<double>{1.0 - 10.0, 10.0}));
  EXPECT_EQ(SUNStepper_Reset(stepper, 0.0, serial({1, 0}).get()), SUN_SUCCESS);
  data.from = 0.0;
  data.answer = -1;
  EXPECT_NE(SUNStepper_Evolve(stepper, 1.0, y.get(), &reached), SUN_SUCCESS);
  int flag = 0;
  SUNStepper_GetLastFlag(stepper, &flag);
  EXPECT_EQ(flag, APSIS_CALLBACK_ERROR);
  SUNStepper_Destroy(&stepper);
}
#endif

TEST(sundials_settings, report_callbacks_that_fail_with_step_and_time) {
  script data{.from = 0.5, .answer = -7};
  const auto s = of_script("md-imex-6-3", data);
  const auto y = serial({0, 0});
  double reached = 0;
  EXPECT_EQ(apsis_sundials_evolve(s.get(), 1.0, y.get(), &reached), APSIS_CALLBACK_ERROR);
  const std::string message = apsis_error_message();
  EXPECT_EQ(message.find("the callback 'transport' failed (it returned -7)"), 0U) << message;
  EXPECT_NE(message.find("[step 33, t = 0.5]"), std::string::npos) << message;
  EXPECT_EQ(reached, 0.5);
  EXPECT_TRUE(std::isfinite(values(y.get())[0]));
  data.answer = 0;
  data.value = std::nan("");
  EXPECT_EQ(apsis_sundials_evolve(s.get(), 1.0, nullptr, nullptr), APSIS_NUMERICAL_ERROR);
  EXPECT_NE(std::string(apsis_error_message()).find("'transport' at t = 0.5"), std::string::npos)
      << apsis_error_message();
  data.value = 0.0;
  expect_ok(apsis_sundials_evolve(s.get(), 1.0, nullptr, nullptr));
}

TEST(sundials_settings, solve_stages_by_the_program_with_the_same_result) {
  for (const double epsilon : {1.0, 1e-3, 1e-6}) {
    script data{.epsilon = epsilon};
    const auto by_newton = of_script("md-imex-6-3", data), by_program = of_script("md-imex-6-3", data);
    expect_ok(apsis_sundials_set_stage(by_program.get(), stage));
    const auto first = serial({0, 0}), second = serial({0, 0});
    expect_ok(apsis_sundials_evolve(by_newton.get(), 1.0, first.get(), nullptr));
    expect_ok(apsis_sundials_evolve(by_program.get(), 1.0, second.get(), nullptr));
    // Differences of the linear Q are exact up to rounding. The quotient multiplies the rounding
    // errors by 1e5.
    for (std::size_t i = 0; i < 2; ++i)
      EXPECT_NEAR(values(first.get())[i], values(second.get())[i], 1e-9) << epsilon;
    EXPECT_EQ(apsis_sundials_count(by_program.get(), APSIS_SUNDIALS_NEWTON_ITERATIONS), 0);
  }
}

TEST(sundials_settings, end_runs_that_are_too_stiff_without_a_preconditioner) {
  // Slow components of the solution would have errors of 1e-5 (measured).
  script data{.epsilon = 1e-9};
  const auto s = of_script("md-imex-6-3", data);
  EXPECT_EQ(apsis_sundials_evolve(s.get(), 1.0, nullptr, nullptr), APSIS_NUMERICAL_ERROR);
  EXPECT_NE(std::string(apsis_error_message()).find("too stiff for GMRES without a preconditioner"),
            std::string::npos)
      << apsis_error_message();
}

TEST(sundials_settings, integrate_collisions_that_depend_on_time) {
  // Without T, implicit methods integrate time as part of Q. u' = −(u − cos t)/ε + … has the solution cos t.
  const auto error_of = [](const std::string& name, int steps) {
    double epsilon = 0.2;
    const auto rate = [](double t, N_Vector y, N_Vector out, void* of) {
      const double* u = N_VGetArrayPointer(y);
      N_VGetArrayPointer(out)[0] = -(u[0] - std::cos(t)) / *static_cast<double*>(of) - std::sin(t);
      return 0;
    };
    const auto y = serial({1});
    auto s = make(name, nullptr, rate, 0.0, y.get(), &epsilon);
    expect_ok(apsis_sundials_set_step(s.get(), 2.0 / steps));
    expect_ok(apsis_sundials_evolve(s.get(), 2.0, y.get(), nullptr));
    return std::abs(values(y.get())[0] - std::cos(2.0));
  };
  EXPECT_GT(std::log2(error_of("imdrk-3-3", 20) / error_of("imdrk-3-3", 40)), 2.7);
  EXPECT_GT(std::log2(error_of("md-imex-6-3", 160) / error_of("md-imex-6-3", 320)), 2.7);
}

TEST(sundials_settings, integrate_collisions_of_any_time_scale) {
  // u' = −5ω (u − cos ωt) − ω sin ωt with a unit of time of 2^−30 or 2^30, about 1e-9 or 1e9. Powers of two
  // leave the rounding errors of all products unchanged, so that results are equal apart from sums in
  // another order.
  const auto result_of = [](const std::string& name, double omega) {
    const auto rate = [](double t, N_Vector y, N_Vector out, void* of) {
      const double frequency = *static_cast<double*>(of), phase = frequency * t;
      const double* u = N_VGetArrayPointer(y);
      N_VGetArrayPointer(out)[0] = frequency * (-(u[0] - std::cos(phase)) * 5.0 - std::sin(phase));
      return 0;
    };
    const auto y = serial({1});
    auto s = make(name, nullptr, rate, 0.0, y.get(), &omega);
    expect_ok(apsis_sundials_set_step(s.get(), 2.0 / 40 / omega));
    expect_ok(apsis_sundials_evolve(s.get(), 2.0 / omega, y.get(), nullptr));
    return values(y.get())[0];
  };
  for (const std::string name : {"imdrk-3-3", "imdrk-9-5-accurate", "md-imex-6-3"}) {
    const double usual = result_of(name, 1.0);
    EXPECT_NEAR(usual, std::cos(2.0), 1e-3) << name;  // 2.5e-4 with md-imex-6-3
    for (const double omega : {0x1p30, 0x1p-30})
      EXPECT_NEAR(result_of(name, omega), usual, 1e-12) << name << " " << omega;
  }
}

}  // namespace sundials_settings_test
