// Steppers of SUNDIALS give the bits of their integrators, and report errors. CMakeLists.txt chooses
// SUNDIALS, or a stand-in for its interface.
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <sundials/script.hpp>
#include <sundials/support.hpp>

namespace sundials_steppers_test {

namespace {

using namespace sundials_test;

struct destroy_stepper {
  void operator()(SUNStepper s) const { EXPECT_EQ(SUNStepper_Destroy(&s), SUN_SUCCESS); }
};
using stepper = std::unique_ptr<std::remove_pointer_t<SUNStepper>, destroy_stepper>;

stepper of(apsis_sundials* integrator) {
  SUNStepper made = nullptr;
  expect_ok(apsis_sundials_make_stepper(integrator, &made));
  return stepper(made);
}

void expect_success(SUNErrCode returned) {
  EXPECT_EQ(returned, SUN_SUCCESS) << apsis_error_message();
}

int flag_of(SUNStepper s) {
  int flag = -1000;
  expect_success(SUNStepper_GetLastFlag(s, &flag));
  return flag;
}

suncountertype steps_of(SUNStepper s) {
  suncountertype steps = -1;
  expect_success(SUNStepper_GetNumSteps(s, &steps));
  return steps;
}

/// Time and state that a call returned.
struct point {
  double t = -1;
  std::vector<double> y{};
  bool operator==(const point&) const = default;
};

/// Returns what call(y, &t) writes.
template <class Call>
point reached(const Call& call) {
  const auto y = serial({0, 0});
  point found;
  expect_success(call(y.get(), &found.t));
  found.y = values(y.get());
  return found;
}

/// An integrator with a tolerance, so that the lengths of steps depend on all earlier steps.
integrator adaptive(const char* method, script& data) {
  auto s = make(method, transport, collision, 0.0, serial({1, 0}).get(), &data);
  expect_ok(apsis_sundials_set_tolerance(s.get(), 1e-5, 1e-7));
  return s;
}

}  // namespace

TEST(sundials_steppers, give_the_bits_of_the_integrator) {
  for (const char* method : {"md-imex-6-3", "ark-436", "md-imex-16-4-efficient"}) {
    script data, same;
    const auto own = adaptive(method, data), stepped = adaptive(method, same);
    const auto s = of(stepped.get());
    for (const double t : {0.25, 1.0, 1.5})
      EXPECT_EQ(reached([&](N_Vector y, double* at) { return SUNStepper_Evolve(s.get(), t, y, at); }),
                reached([&](N_Vector y, double* at) { return apsis_sundials_evolve(own.get(), t, y, at); }))
          << method << " " << t;
    for (int k = 0; k < 3; ++k)
      EXPECT_EQ(
          reached([&](N_Vector y, double* at) { return SUNStepper_OneStep(s.get(), 3.0, y, at); }),
          reached([&](N_Vector y, double* at) { return apsis_sundials_one_step(own.get(), 3.0, y, at); }))
          << method << " " << k;
    EXPECT_EQ(steps_of(s.get()), apsis_sundials_count(own.get(), APSIS_SUNDIALS_STEPS)) << method;
    EXPECT_GT(steps_of(s.get()), 10) << method;
    EXPECT_EQ(flag_of(s.get()), APSIS_OK) << method;
  }
}

TEST(sundials_steppers, evaluate_both_parts_of_the_right_hand_side) {
  script data;
  const auto s = adaptive("md-imex-6-3", data);
  const auto y = serial({0.7, 0.2}), rate = serial({0, 0});
  for (const auto mode : {SUN_FULLRHS_START, SUN_FULLRHS_END, SUN_FULLRHS_OTHER}) {
    expect_success(SUNStepper_FullRhs(of(s.get()).get(), 0.3, y.get(), rate.get(), mode));
    const double exchanged = (0.7 - 0.2) / data.epsilon;
    EXPECT_EQ(values(rate.get()), (std::vector<double>{std::cos(0.3) - exchanged, exchanged}));
  }
}

TEST(sundials_steppers, start_anew_after_a_reset) {
  for (const bool reset : {true, false}) {
    script data, same;
    const auto own = adaptive("md-imex-6-3", data), stepped = adaptive("md-imex-6-3", same);
    const auto s = of(stepped.get());
    reached([&](N_Vector y, double* t) { return SUNStepper_Evolve(s.get(), 1.0, y, t); });
    const auto before = steps_of(s.get());
    EXPECT_GT(before, 10);
    const auto y = serial({0.5, 0.4});
    expect_success(reset ? SUNStepper_Reset(s.get(), 0.25, y.get())
                         : SUNStepper_ReInit(s.get(), 0.25, y.get()));
    // Reset() continues to count, ReInit() does not.
    EXPECT_EQ(steps_of(s.get()), reset ? before : 0);
    expect_ok(apsis_sundials_reset(own.get(), 0.25, y.get()));
    EXPECT_EQ(reached([&](N_Vector v, double* t) { return SUNStepper_Evolve(s.get(), 0.5, v, t); }),
              reached([&](N_Vector v, double* t) { return apsis_sundials_evolve(own.get(), 0.5, v, t); }));
  }
}

TEST(sundials_steppers, end_a_step_at_the_stop_time) {
  script data;
  const auto integrator = of_script("md-imex-6-3", data);
  const auto s = of(integrator.get());
  const double stop = 0.01;  // inside the first step of 1/64
  expect_success(SUNStepper_SetStopTime(s.get(), stop));
  EXPECT_EQ(reached([&](N_Vector y, double* t) { return SUNStepper_OneStep(s.get(), 1.0, y, t); }).t, stop);
}

TEST(sundials_steppers, combine_to_a_splitting_of_second_order) {
  // The parts of Strang's splitting are the exchange, and u' = cos t. The mean of u and v is (1 + sin t)/2.
  const auto solve = [](int steps) {
    script data{.epsilon = 1.0}, same{.epsilon = 1.0};
    const auto y = serial({1, 0});
    const auto first = make("imdrk-9-5-accurate", nullptr, collision, 0.0, y.get(), &data);
    const auto second = make("md-imex-6-3", transport, nullptr, 0.0, y.get(), &same);
    for (const auto* one : {&first, &second}) expect_ok(apsis_sundials_set_step(one->get(), 1.0 / 64));
    const auto of_first = of(first.get()), of_second = of(second.get());
    const auto advance = [&](const stepper& by, double begin, double end) {
      double t = 0;
      expect_success(SUNStepper_Reset(by.get(), begin, y.get()));
      expect_success(SUNStepper_Evolve(by.get(), end, y.get(), &t));
      EXPECT_EQ(t, end);
    };
    for (int k = 0; k < steps; ++k) {
      const double begin = double(k) / steps, end = double(k + 1) / steps, middle = (begin + end) / 2;
      advance(of_first, begin, middle);
      advance(of_second, begin, end);
      advance(of_first, middle, end);
    }
    return values(y.get());
  };
  script data{.epsilon = 1.0};
  const auto whole = make("md-imex-6-3", transport, collision, 0.0, serial({1, 0}).get(), &data);
  expect_ok(apsis_sundials_set_step(whole.get(), 1.0 / 512));
  const auto truth =
      reached([&](N_Vector y, double* t) { return apsis_sundials_evolve(whole.get(), 1, y, t); });
  const auto error = [&](int steps) { return std::abs(solve(steps)[0] - truth.y[0]); };
  EXPECT_NEAR(std::log2(error(4) / error(8)), 2.0, 0.2);
  EXPECT_NEAR(solve(4)[0] + solve(4)[1], 1.0 + std::sin(1.0), 1e-8);
}

TEST(sundials_steppers, report_the_status_of_errors) {
  script data{.from = 0.5, .answer = -3};
  const auto integrator = of_script("md-imex-6-3", data);
  const auto s = of(integrator.get());
  const auto y = serial({0, 0});
  double t = 0;
  EXPECT_EQ(SUNStepper_Evolve(s.get(), 1.0, y.get(), &t), SUN_ERR_EXT_FAIL);
  EXPECT_EQ(flag_of(s.get()), APSIS_CALLBACK_ERROR);
  EXPECT_LE(t, 0.5);
  EXPECT_GT(t, 0.4);
  EXPECT_EQ(SUNStepper_Evolve(s.get(), 0.1, y.get(), &t), SUN_ERR_EXT_FAIL);  // backward
  EXPECT_EQ(flag_of(s.get()), APSIS_INPUT_ERROR);
  EXPECT_EQ(SUNStepper_Reset(s.get(), 0.0, serial({1, 2, 3}).get()), SUN_ERR_EXT_FAIL);
  EXPECT_NE(std::string(apsis_error_message()).find("a vector has 3 elements"), std::string::npos);
  EXPECT_EQ(SUNStepper_FullRhs(s.get(), 0.75, y.get(), serial({0, 0}).get(), SUN_FULLRHS_OTHER),
            SUN_ERR_EXT_FAIL);
  EXPECT_EQ(flag_of(s.get()), APSIS_CALLBACK_ERROR);
}

TEST(sundials_steppers, need_an_integrator_and_a_place) {
  script data;
  const auto integrator = of_script("md-imex-6-3", data);
  SUNStepper made = nullptr;
  EXPECT_EQ(apsis_sundials_make_stepper(nullptr, &made), APSIS_INPUT_ERROR);
  EXPECT_NE(std::string(apsis_error_message()).find("the integrator is NULL"), std::string::npos);
  EXPECT_EQ(made, nullptr);
  EXPECT_EQ(apsis_sundials_make_stepper(integrator.get(), nullptr), APSIS_INPUT_ERROR);
  EXPECT_NE(std::string(apsis_error_message()).find("the place of the stepper is NULL"), std::string::npos);
}

#ifdef APSIS_STAND_IN
TEST(sundials_steppers, that_cannot_be_completed_are_destroyed) {
  script data;
  const auto integrator = of_script("md-imex-6-3", data);
  int calls = 0;
  for (int status = APSIS_INPUT_ERROR; status != APSIS_OK;) {
    SUNStepper made = nullptr;
    stand_in_failing_call = ++calls;
    status = apsis_sundials_make_stepper(integrator.get(), &made);
    if (status == APSIS_OK) {
      EXPECT_EQ(stand_in_steppers, 1);
      SUNStepper_Destroy(&made);
    } else {
      EXPECT_EQ(status, APSIS_INPUT_ERROR);
      EXPECT_NE(std::string(apsis_error_message()).find("SUNDIALS does not make a stepper (it returned -2)"),
                std::string::npos)
          << apsis_error_message();
      EXPECT_EQ(made, nullptr);
    }
    EXPECT_EQ(stand_in_steppers, 0) << calls;
  }
  stand_in_failing_call = 0;
  EXPECT_GT(calls, 8);  // the first is SUNStepper_Create(), and at least seven others follow
}
#endif

}  // namespace sundials_steppers_test
