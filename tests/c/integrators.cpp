// Integrators of the C interface: settings, failing callbacks, counts and refusals.
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <thread>
#include <vector>

#include <c/ode.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <support/bad_input.hpp>

namespace c_integrators_test {

namespace {

using namespace c_interface;
using testing::HasSubstr;

/// Answers of the callbacks of a test.
struct script {
  double epsilon = 0.1;
  double from = std::numeric_limits<double>::infinity();  ///< time after which the transport behaves as below
  int answer = 0;                                         ///< value that the transport then returns
  double value = 0.0;                                     ///< number that it then adds to T
  apsis_integrator* called = nullptr;
  std::vector<int> statuses{};
};

int scripted_transport(double t, size_t n, const double* u, double* out, void* data) {
  const auto& now = *static_cast<const script*>(data);
  transport(t, n, u, out, data);
  if (t < now.from) return 0;
  out[0] += now.value;
  return now.answer;
}

int scripted_stage(double t, double a, double b, size_t n, double* u, void* data) {
  ode of{static_cast<const script*>(data)->epsilon};
  return stage(t, a, b, n, u, &of);
}

integrator of_script(const char* name, script& data) {
  auto s = make(name, 2);
  apsis_set_data(s.get(), &data);
  apsis_set_transport(s.get(), scripted_transport);
  apsis_set_stage(s.get(), scripted_stage);
  apsis_set_step(s.get(), 1.0 / 64);
  const double u0[] = {2, 0};
  EXPECT_EQ(apsis_start(s.get(), 0, u0), APSIS_OK);
  return s;
}

std::array<double, 2> state_of(const integrator& s) {
  const double* u = apsis_state(s.get());
  return {u[0], u[1]};
}

}  // namespace

TEST(c_integrators, continue_from_the_time_reached_and_stop_at_the_observer) {
  struct watched {
    ode of{0.1};
    long long last = 0, stop_after = 0;
  } data;
  auto s = of_ode("md-imex-6-3", data.of);
  apsis_set_step(s.get(), 1.0 / 64);
  EXPECT_EQ(apsis_integrate(s.get(), 0.25), APSIS_OK);
  apsis_set_observer(s.get(), [](long long step, double t, double dt, size_t n, const double*, void* of) {
    auto& now = *static_cast<watched*>(of);
    EXPECT_EQ(step, now.last == 0 ? 17 : now.last + 1);
    EXPECT_EQ(t, static_cast<double>(step) / 64);
    EXPECT_EQ(dt, 1.0 / 64);
    EXPECT_EQ(n, 2U);
    now.last = step;
    return step == now.stop_after ? 1 : 0;
  });
  data.stop_after = 20;
  EXPECT_EQ(apsis_integrate(s.get(), 1), APSIS_STOPPED);
  EXPECT_EQ(apsis_time(s.get()), 20.0 / 64);
  EXPECT_EQ(apsis_integrate(s.get(), 1), APSIS_OK);
  EXPECT_EQ(data.last, 64);
  auto whole = of_ode("md-imex-6-3", data.of);
  apsis_set_step(whole.get(), 1.0 / 64);
  EXPECT_EQ(apsis_integrate(whole.get(), 1), APSIS_OK);
  EXPECT_EQ(state_of(s), state_of(whole));
}

TEST(c_integrators, count_evaluations) {
  ode data{0.1};
  auto s = of_ode("md-imex-6-3", data);
  apsis_set_step(s.get(), 1.0 / 64);
  EXPECT_EQ(apsis_integrate(s.get(), 1), APSIS_OK);
  double of_t = 0, of_q = 0;
  const auto m = find("md-imex-6-3");
  apsis_method_fact(m.get(), "explicit_evaluations", &of_t);
  apsis_method_fact(m.get(), "implicit_solves", &of_q);
  EXPECT_EQ(apsis_count(s.get(), APSIS_STEPS), 64);
  EXPECT_EQ(static_cast<double>(apsis_count(s.get(), APSIS_TRANSPORT_EVALUATIONS)), 64 * of_t);
  EXPECT_EQ(static_cast<double>(apsis_count(s.get(), APSIS_STAGE_SOLVES)), 64 * of_q);
  EXPECT_EQ(apsis_count(s.get(), APSIS_RATE_EVALUATIONS), 0);
  EXPECT_EQ(apsis_count(s.get(), APSIS_PRECONDITIONER_SOLVES + 1), -1);
  const double again[] = {2, 0};
  apsis_start(s.get(), 0, again);
  EXPECT_EQ(apsis_count(s.get(), APSIS_TRANSPORT_EVALUATIONS), 0);
}

TEST(c_integrators, report_callbacks_that_fail_with_step_and_time) {
  script data{.from = 0.5, .answer = -7};
  const auto s = of_script("md-imex-6-3", data);
  EXPECT_EQ(apsis_integrate(s.get(), 1), APSIS_CALLBACK_ERROR);
  EXPECT_THAT(apsis_error_message(), HasSubstr("the callback 'transport' failed (it returned -7)"));
  EXPECT_THAT(apsis_error_message(),
              HasSubstr("[step " + std::to_string(apsis_count(s.get(), APSIS_STEPS) + 1) + ", t = "));
  EXPECT_LE(apsis_time(s.get()), 0.5);
  EXPECT_GT(apsis_time(s.get()), 0.45);
  data.answer = 0;
  EXPECT_EQ(apsis_integrate(s.get(), 1), APSIS_OK) << apsis_error_message();  // from the last accepted step
}

TEST(c_integrators, store_errors_of_libraries_that_extend_the_interface) {
  EXPECT_EQ(apsis_store_error(APSIS_FILE_ERROR, "a file is missing (it was removed); restore it"),
            APSIS_FILE_ERROR);
  EXPECT_STREQ(apsis_error_message(), "a file is missing (it was removed); restore it");
  std::thread([] { EXPECT_STREQ(apsis_error_message(), ""); }).join();
  EXPECT_EQ(apsis_store_error(-99, nullptr), -99);
  EXPECT_STREQ(apsis_error_message(), "");
}

TEST(c_integrators, name_the_callback_that_gives_nan) {
  script data{.from = 0.5, .value = std::nan("")};
  const auto s = of_script("md-imex-6-3", data);
  EXPECT_EQ(apsis_integrate(s.get(), 1), APSIS_NUMERICAL_ERROR);
  EXPECT_THAT(apsis_error_message(),
              HasSubstr("the result of the callback 'transport' is not finite (component 0)"));
  EXPECT_THAT(apsis_error_message(), HasSubstr("[step "));
  for (const double x : state_of(s)) EXPECT_TRUE(std::isfinite(x));
}

TEST(c_integrators, repeat_steps_that_a_callback_rejects_if_a_tolerance_controls_them) {
  // The transport is defined for u1 < 2.5 only. A first step of length 1 leaves this set, and shorter steps
  // stay inside.
  script data{.epsilon = 1e-3};
  const auto limited = [](double t, size_t n, const double* u, double* out, void* of) {
    transport(t, n, u, out, of);
    return u[0] < 2.5 ? 0 : 3;
  };
  const auto s = of_script("md-imex-6-3", data);
  apsis_set_transport(s.get(), limited);
  apsis_set_step(s.get(), 0.8);
  EXPECT_EQ(apsis_integrate(s.get(), 0.8), APSIS_NUMERICAL_ERROR);
  EXPECT_THAT(apsis_error_message(), HasSubstr("the callback 'transport' rejects a state (it returned 3)"));
  EXPECT_EQ(apsis_time(s.get()), 0.0);
  apsis_set_tolerance(s.get(), 0, 0.1);
  EXPECT_EQ(apsis_integrate(s.get(), 0.5), APSIS_OK) << apsis_error_message();
  EXPECT_LT(apsis_state(s.get())[0], 2.5);
}

TEST(c_integrators, observers_end_an_integration_with_an_error) {
  ode data{0.1};
  auto s = of_ode("md-imex-6-3", data);
  apsis_set_step(s.get(), 1.0 / 64);
  apsis_set_observer(s.get(), [](long long, double, double, size_t, const double*, void*) { return -1; });
  EXPECT_EQ(apsis_integrate(s.get(), 1), APSIS_CALLBACK_ERROR);
  EXPECT_THAT(apsis_error_message(), HasSubstr("the callback 'observer' failed (it returned -1)"));
  EXPECT_EQ(apsis_count(s.get(), APSIS_STEPS), 1);
}

TEST(c_integrators, refuse_calls_of_their_callbacks) {
  script data;
  const auto s = of_script("md-imex-6-3", data);
  data.called = s.get();
  apsis_set_observer(s.get(), [](long long, double, double, size_t, const double* u, void* of) {
    auto& now = *static_cast<script*>(of);
    now.statuses.push_back(apsis_integrate(now.called, 2));
    now.statuses.push_back(apsis_set_step(now.called, 0.5));
    now.statuses.push_back(apsis_start(now.called, 0, u));
    EXPECT_EQ(apsis_state(now.called), u);  // a callback may read the state
    return 1;
  });
  EXPECT_EQ(apsis_integrate(s.get(), 1), APSIS_STOPPED);
  EXPECT_THAT(data.statuses, testing::ElementsAre(APSIS_INPUT_ERROR, APSIS_INPUT_ERROR, APSIS_INPUT_ERROR));
  EXPECT_THAT(apsis_error_message(), HasSubstr("the integrator is in use"));
}

TEST(c_integrators, solve_blocks_as_problems_of_their_own) {
  // Q couples the two unknowns of a cell; cells have their own ε.
  static const double epsilon[] = {1e-6, 0.3, 1e-2};
  const auto of_block = [](size_t block, size_t n, const double* u, double* q, void*) {
    ode of{epsilon[block]};
    return rate(block, n, u, q, &of);
  };
  const auto jacobian = [](size_t block, size_t, const double* u, double* j, void*) {
    const double k = (1 + u[0] * u[0]) / epsilon[block];
    j[0] = j[1] = 0;
    j[2] = k * std::cos(u[0]) + 2 * u[0] / epsilon[block] * (std::sin(u[0]) - u[1]);
    j[3] = -k;
    return 0;
  };
  const auto of_all = [](double t, size_t n, const double* u, double* out, void* data) {
    for (size_t i = 0; i < n; i += 2) transport(t, 2, u + i, out + i, data);
    return 0;
  };
  auto all = make("md-imex-6-3", 6);
  apsis_set_transport(all.get(), of_all);
  apsis_set_rate(all.get(), of_block);
  apsis_set_jacobian(all.get(), jacobian);
  ASSERT_EQ(apsis_set_block_size(all.get(), 2), APSIS_OK);
  apsis_set_step(all.get(), 1.0 / 64);
  const double u0[] = {2, 0, 2, 0, 2, 0};
  apsis_start(all.get(), 0, u0);
  ASSERT_EQ(apsis_integrate(all.get(), 1), APSIS_OK) << apsis_error_message();
  EXPECT_EQ(apsis_count(all.get(), APSIS_STAGE_SOLVES), 64 * 6 * 3);
  EXPECT_GE(apsis_count(all.get(), APSIS_NEWTON_ITERATIONS), 64 * 6 * 3);
  EXPECT_GT(apsis_count(all.get(), APSIS_JACOBIAN_EVALUATIONS), 0);
  for (std::size_t k = 0; k < 3; ++k) {
    ode data{epsilon[k]};
    auto one = of_ode("md-imex-6-3", data);  // by closed formulas
    apsis_set_step(one.get(), 1.0 / 64);
    ASSERT_EQ(apsis_integrate(one.get(), 1), APSIS_OK);
    // Newton's method ends at rounding errors. The stiffest block divides them by ε = 1e-6 in Q̇ = Q'Q.
    for (std::size_t i = 0; i < 2; ++i)
      EXPECT_NEAR(apsis_state(all.get())[2 * k + i], apsis_state(one.get())[i], 1e-9) << "block " << k;
  }
}

TEST(c_integrators, keep_newtons_method_inside_the_admissible_states) {
  // Q = −√u has no real value below 0. A Newton step from u = 1 with a large Δt would reach such u.
  const auto root = [](size_t, size_t, const double* u, double* q, void*) {
    q[0] = -std::sqrt(u[0]);
    return 0;
  };
  const auto derivative = [](size_t, size_t, const double* u, double* j, void*) {
    j[0] = -0.5 / std::sqrt(u[0]);
    return 0;
  };
  const auto positive = [](size_t, size_t, const double* u, int* result, void*) {
    *result = u[0] > 0 ? 1 : 0;
    return 0;
  };
  auto s = make("imdrk-1-2", 1);
  apsis_set_rate(s.get(), root);
  apsis_set_jacobian(s.get(), derivative);
  apsis_set_admissible(s.get(), positive);
  apsis_set_step(s.get(), 0.25);
  const double u0[] = {1};
  apsis_start(s.get(), 0, u0);
  ASSERT_EQ(apsis_integrate(s.get(), 1), APSIS_OK) << apsis_error_message();
  EXPECT_NEAR(apsis_state(s.get())[0], 0.25, 0.01);  // exact value (1 − t/2)² at t = 1; four steps of order 2
}

TEST(c_integrators, of_two_threads_do_not_disturb_each_other) {
  const auto integrate = [](const char* name, double epsilon, std::vector<double>& states,
                            std::string& message) {
    for (int k = 0; k < 20; ++k) {
      ode data{epsilon};
      const auto s = of_ode(name, data);
      apsis_set_step(s.get(), 1.0 / 64);
      apsis_method* none = nullptr;
      EXPECT_EQ(apsis_find_method((std::string(name) + "-none").c_str(), &none), APSIS_INPUT_ERROR);
      EXPECT_EQ(apsis_integrate(s.get(), 1), APSIS_OK);
      states.push_back(apsis_state(s.get())[0]);
      message = apsis_error_message();
    }
  };
  std::vector<double> alone[2], beside[2];
  std::string message[2];
  integrate("md-imex-6-3", 0.1, alone[0], message[0]);
  integrate("md-imex-3-2", 1e-4, alone[1], message[1]);
  std::thread first([&] { integrate("md-imex-6-3", 0.1, beside[0], message[0]); });
  std::thread second([&] { integrate("md-imex-3-2", 1e-4, beside[1], message[1]); });
  first.join();
  second.join();
  EXPECT_EQ(beside[0], alone[0]);
  EXPECT_EQ(beside[1], alone[1]);
  EXPECT_THAT(message[0], HasSubstr("'md-imex-6-3-none'"));
  EXPECT_THAT(message[1], HasSubstr("'md-imex-3-2-none'"));
}

TEST(c_integrators, of_two_threads_may_share_a_method) {
  const auto m = find("md-imex-8-3");
  const char* texts[2] = {nullptr, nullptr};
  std::thread first([&] { apsis_method_certificate(m.get(), &texts[0]); });
  std::thread second([&] { apsis_method_certificate(m.get(), &texts[1]); });
  first.join();
  second.join();
  EXPECT_NE(texts[0], nullptr);
  EXPECT_EQ(texts[0], texts[1]);
}

TEST(c_integrators, refuse_bad_settings) {
  ode data{0.1};
  const auto ready = [&data](const char* name) { return of_ode(name, data); };
  const auto advance = [](const integrator& s) { rethrow(apsis_integrate(s.get(), 1)); };
  const double infinite[] = {1, std::numeric_limits<double>::infinity()};
  const double negative[] = {1e-6, -1e-6};
  apsis_integrator* none = nullptr;
  const auto jacobian = [](size_t, size_t, const double*, double*, void*) { return 0; };
  const auto always = [](double, size_t, const double*, double* result, void*) {
    *result = 1;
    return 0;
  };
  const auto s = ready("md-imex-6-3");
  bad_input::expect_refused({
      {[&] { rethrow(apsis_new_integrator(find("md-imex-6-3").get(), 0, &none)); },
       {"there are no unknowns"}},
      {[&] { rethrow(apsis_new_integrator(find("md-imex-6-3").get(), static_cast<size_t>(-1), &none)); },
       {"more than memory has addresses"}},
      {[&] { rethrow(apsis_new_integrator(nullptr, 1, &none)); }, {"the method is NULL"}},
      {[&] { rethrow(apsis_set_step(nullptr, 1)); }, {"the integrator is NULL"}},
      {[&] { rethrow(apsis_set_step(s.get(), -1)); }, {"dt is -1"}},
      {[&] { rethrow(apsis_set_safety(s.get(), 0)); }, {"the safety is 0"}},
      {[&] { rethrow(apsis_set_tolerance(s.get(), -1, 1)); }, {"the relative tolerance is -1"}},
      {[&] { rethrow(apsis_set_tolerance(s.get(), 1e-6, 0)); }, {"an absolute tolerance is 0"}},
      {[&] { rethrow(apsis_set_tolerances(s.get(), 1e-6, negative)); }, {"an absolute tolerance is -1e-06"}},
      {[&] { rethrow(apsis_set_tolerances(s.get(), 1e-6, nullptr)); }, {"absolute tolerances is NULL"}},
      {[&] { rethrow(apsis_set_controller(s.get(), "pdi")); },
       {"unknown controller 'pdi'", "valid: predictive, integral, pi, pid"}},
      {[&] { rethrow(apsis_set_controller(s.get(), nullptr)); }, {"the name of the controller is NULL"}},
      {[&] { rethrow(apsis_set_graded_start(s.get(), 65)); }, {"the growth of a graded start is 65"}},
      {[&] { rethrow(apsis_set_block_size(s.get(), 3)); }, {"2 unknowns are not a sequence of blocks of 3"}},
      {[&] { rethrow(apsis_start(s.get(), 0, infinite)); },
       {"the initial state is not finite (component 1 is inf)"}},
      {[&] { rethrow(apsis_start(s.get(), std::nan(""), negative)); }, {"the initial time is not finite"}},
      {[&] { rethrow(apsis_start(s.get(), 0, nullptr)); }, {"the initial state is NULL"}},
      {[&] { rethrow(apsis_integrate(make("md-imex-6-3", 1).get(), 1)); }, {"apsis_start() was not called"}},
      {[&] { rethrow(apsis_integrate(s.get(), -1)); },
       {"the end of the integration is -1 (the time reached is 0)"}},
      {[&] { advance(ready("md-imex-6-3")); }, {"the step size is unknown", "apsis_set_tolerance()"}},
      {[&] {
         const auto one = ready("md-imex-6-3");
         apsis_set_step(one.get(), 0.1);
         apsis_set_forward_euler_step(one.get(), always);
         advance(one);
       },
       {"dt and a forward Euler step are given"}},
      {[&] {
         const auto one = ready("ars-222");  // its SSP coefficient is 0
         apsis_set_forward_euler_step(one.get(), always);
         advance(one);
       },
       {"method 'ars-222' has no step length in units of the forward Euler step"}},
      {[&] {
         const auto one = ready("imex-bdf-3");
         apsis_set_tolerance(one.get(), 1e-6, 1e-9);
         advance(one);
       },
       {"'imex-bdf-3' cannot follow a tolerance"}},
      {[&] {
         const auto one = ready("md-imex-6-3");
         apsis_set_step(one.get(), 0.1);
         apsis_set_graded_start(one.get(), 2);
         advance(one);
       },
       {"a graded start needs the width of the initial layer", "apsis_set_relaxation_time()"}},
      {[&] {
         const auto one = ready("md-imex-6-3");
         apsis_set_step(one.get(), 0.1);
         apsis_set_jacobian(one.get(), jacobian);
         advance(one);
       },
       {"a stage solver and derivatives of Q are given"}},
      {[&] {
         const auto one = ready("md-imex-6-3");
         apsis_set_step(one.get(), 0.1);
         apsis_set_stage(one.get(), nullptr);
         apsis_set_rate(one.get(), nullptr);
         advance(one);
       },
       {"method 'md-imex-6-3' solves stages (and there is neither a stage solver nor a rate)",
        "apsis_set_rate()"}},
      {[&] {
         const auto one = ready("md-imex-6-3");
         apsis_set_step(one.get(), 0.1);
         apsis_set_stage(one.get(), nullptr);
         apsis_set_rate(one.get(), nullptr);
         apsis_set_jacobian(one.get(), jacobian);
         advance(one);
       },
       {"derivatives of Q are given without Q"}},
      {[&] {
         const auto one = ready("md-imex-6-3");
         apsis_set_step(one.get(), 0.1);
         apsis_set_stage(one.get(), nullptr);
         apsis_set_jacobian(one.get(), jacobian);
         apsis_set_relaxation_time(one.get(), relaxation_time);
         advance(one);
       },
       {"a relaxation time is given and Newton's method solves the stages"}},
      {[&] {
         const auto one = ready("md-imex-6-3");
         apsis_set_step(one.get(), 0.1);
         apsis_set_stage(one.get(), nullptr);  // the rate remains
         apsis_set_relaxation_time(one.get(), relaxation_time);
         advance(one);
       },
       {"a relaxation time is given and Newton's method solves the stages"}},
      {[&] {
         const auto one = ready("dop853");
         apsis_set_step(one.get(), 0.1);
         apsis_set_rate(one.get(), nullptr);
         advance(one);
       },
       {"method 'dop853' evaluates Q (and there is no rate)"}},
      {[&] {
         const auto one = ready("exponential-2");
         apsis_set_step(one.get(), 0.1);
         apsis_set_flow(one.get(), nullptr);
         advance(one);
       },
       {"method 'exponential-2' solves u' = Q(u) exactly", "apsis_set_flow()"}},
      {[&] {
         const auto one = ready("imdrk-3-3");
         apsis_set_step(one.get(), 0.1);
         advance(one);
       },
       {"method 'imdrk-3-3' cannot integrate this problem (it is implicit only and the problem has "
        "transport)"}},
  });
  EXPECT_EQ(apsis_state(nullptr), nullptr);
  EXPECT_EQ(apsis_count(nullptr, APSIS_STEPS), -1);
  EXPECT_TRUE(std::isnan(apsis_time(nullptr)));
  apsis_free_integrator(nullptr);
}

}  // namespace c_integrators_test
