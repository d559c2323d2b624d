// Dense output, events and stop times of the C interface.
#include <apsis/integrate/evolution.hpp>
#include <apsis/integrate/relaxation_problem.hpp>

#include <cmath>
#include <limits>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <c/ode.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <support/bad_input.hpp>

namespace c_events_test {

namespace {

using namespace c_interface;
using testing::HasSubstr;
using state = std::vector<double>;
using rule = apsis::step_rule<double>;

/// The model of ode.hpp, and the events and times that its callbacks record.
struct watched {
  ode of{0.1};
  apsis_integrator* called = nullptr;
  std::vector<std::pair<std::size_t, double>> events;
  std::vector<double> times, middles;
  int answer = 0;
};

int levels(double, size_t, const double* u, size_t count, double* g, void*) {
  for (std::size_t k = 0; k < count; ++k) g[k] = u[0] - 2.1 - 0.2 * static_cast<double>(k);
  return 0;
}

int see_event(size_t k, double t, size_t, const double*, void* data) {
  auto& now = *static_cast<watched*>(data);
  now.events.emplace_back(k, t);
  return now.answer;
}

int see_step(long long, double t, double dt, size_t n, const double*, void* data) {
  auto& now = *static_cast<watched*>(data);
  now.times.push_back(t);
  state u(n);
  EXPECT_EQ(apsis_state_at(now.called, t - dt / 2, u.data()), APSIS_OK) << apsis_error_message();
  now.middles.push_back(u[0]);
  return 0;
}

integrator of_watched(const char* name, watched& data) {
  auto s = of_ode(name, data.of);
  data.called = s.get();
  apsis_set_step(s.get(), 1.0 / 32);
  return s;
}

}  // namespace

TEST(c_events, and_dense_output_have_the_bits_of_an_evolution) {
  watched data;
  const auto s = of_watched("md-imex-6-3", data);
  const int ends[] = {0, 1};
  apsis_set_events(s.get(), 2, levels, nullptr, ends);
  apsis_set_event_observer(s.get(), see_event);
  apsis_set_observer(s.get(), see_step);
  const double stops[] = {0.05, 0.15};
  apsis_set_stop_times(s.get(), 2, stops);
  EXPECT_EQ(apsis_integrate(s.get(), 1), APSIS_EVENT) << apsis_error_message();

  auto problem = apsis::relaxation_problem(
      [](double, const state& u, state& out) { out = {u[1], 0}; }, [](const state& u) { return u[0]; },
      [](double w, state& e) { e = {w, std::sin(w)}; }, [](double w) { return 1 + w * w; }, data.of.epsilon);
  apsis::evolution one(apsis::find_integrator("md-imex-6-3"), problem, rule::fixed(1.0 / 32));
  one.set_events({2,
                  [](double t, const state& u, std::span<double> g) {
                    levels(t, u.size(), u.data(), g.size(), g.data(), nullptr);
                  },
                  {},
                  {false, true}});
  one.set_stops({0.05, 0.15});
  one.start(0, {2, 0});
  state times, middles;
  EXPECT_EQ(one.advance(1,
                        [&](long, double t, double dt, const state&) {
                          times.push_back(t);
                          middles.push_back(one.at(t - dt / 2)[0]);
                          return true;
                        }),
            apsis::evolution_end::event);
  EXPECT_EQ(data.times, times);
  EXPECT_EQ(data.middles, middles);
  EXPECT_THAT(times, testing::AllOf(testing::Contains(0.05), testing::Contains(0.15)));
  ASSERT_EQ(apsis_count(s.get(), APSIS_EVENTS), 2);
  ASSERT_EQ(one.found().size(), 2U);
  ASSERT_EQ(data.events.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    std::size_t k = 9;
    double t = 0;
    EXPECT_EQ(apsis_found_event(s.get(), i, &k, &t), APSIS_OK);
    EXPECT_EQ(k, one.found()[i].function);
    EXPECT_EQ(t, one.found()[i].t);
    EXPECT_EQ(data.events[i], std::make_pair(k, t));
  }
  EXPECT_EQ(apsis_time(s.get()), one.t());
  EXPECT_EQ(state(apsis_state(s.get()), apsis_state(s.get()) + 2), one.u());
}

TEST(c_events, stay_known_when_settings_change) {
  watched data;
  const auto s = of_watched("md-imex-6-3", data);
  apsis_set_events(s.get(), 2, levels, nullptr, nullptr);
  EXPECT_EQ(apsis_integrate(s.get(), 1), APSIS_EVENT);
  apsis_set_step(s.get(), 1.0 / 64);
  state u(2);
  EXPECT_EQ(apsis_state_at(s.get(), apsis_time(s.get()), u.data()), APSIS_OK);
  EXPECT_EQ(apsis_state_at(s.get(), 0.0, u.data()), APSIS_INPUT_ERROR);
  EXPECT_THAT(apsis_error_message(), HasSubstr("none has the present settings"));
  EXPECT_EQ(apsis_integrate(s.get(), 1), APSIS_EVENT);
  EXPECT_EQ(apsis_count(s.get(), APSIS_EVENTS), 2);
  std::size_t k = 9;
  double first = 0, second = 0;
  EXPECT_EQ(apsis_found_event(s.get(), 0, &k, &first), APSIS_OK);
  EXPECT_EQ(k, 0U);
  EXPECT_EQ(apsis_found_event(s.get(), 1, &k, &second), APSIS_OK);
  EXPECT_EQ(k, 1U);
  EXPECT_LT(first, second);
  const double again[] = {2, 0};
  apsis_start(s.get(), 0, again);
  EXPECT_EQ(apsis_count(s.get(), APSIS_EVENTS), 0);
}

TEST(c_events, that_callbacks_refuse_end_the_integration) {
  watched data;
  data.answer = -5;
  const auto s = of_watched("md-imex-6-3", data);
  apsis_set_events(s.get(), 1, levels, nullptr, nullptr);
  apsis_set_event_observer(s.get(), see_event);
  EXPECT_EQ(apsis_integrate(s.get(), 1), APSIS_CALLBACK_ERROR);
  EXPECT_THAT(apsis_error_message(), HasSubstr("the callback 'event_observer' failed (it returned -5)"));
  apsis_set_events(
      s.get(), 1, [](double, size_t, const double*, size_t, double*, void*) { return -6; }, nullptr, nullptr);
  EXPECT_EQ(apsis_integrate(s.get(), 1), APSIS_CALLBACK_ERROR);
  EXPECT_THAT(apsis_error_message(), HasSubstr("the callback 'events' failed (it returned -6)"));
}

TEST(c_events, dense_output_is_for_observers_and_not_for_other_callbacks) {
  struct asking {
    apsis_integrator* called = nullptr;
    int status = 0;
  } data;
  auto s = make("md-imex-6-3", 2);
  data.called = s.get();
  apsis_set_data(s.get(), &data);
  apsis_set_transport(s.get(), [](double t, size_t n, const double* u, double* out, void* of) {
    auto& now = *static_cast<asking*>(of);
    double numbers[2];
    now.status = apsis_state_at(now.called, t, numbers);
    return transport(t, n, u, out, nullptr);
  });
  apsis_set_step(s.get(), 0.25);
  const double u0[] = {2, 0};
  apsis_start(s.get(), 0, u0);
  EXPECT_EQ(apsis_integrate(s.get(), 0.5), APSIS_OK);
  EXPECT_EQ(data.status, APSIS_INPUT_ERROR);
  data.status = 0;
  double numbers[2];
  EXPECT_EQ(apsis_state_at(s.get(), 0.3, numbers), APSIS_OK);
  EXPECT_EQ(data.status, APSIS_INPUT_ERROR);
}

TEST(c_events, dense_output_is_for_the_thread_of_the_observer) {
  struct asking {
    apsis_integrator* called = nullptr;
    std::vector<int> own, others;
    std::string message;
  } data;
  auto s = make("md-imex-6-3", 2);
  data.called = s.get();
  apsis_set_data(s.get(), &data);
  apsis_set_transport(s.get(), transport);
  apsis_set_observer(s.get(), [](long long, double t, double, size_t, const double*, void* of) {
    auto& now = *static_cast<asking*>(of);
    std::thread([&now, t] {
      double numbers[2];
      now.others.push_back(apsis_state_at(now.called, t, numbers));
      now.message = apsis_error_message();
    }).join();
    double numbers[2];
    now.own.push_back(apsis_state_at(now.called, t, numbers));
    return 0;
  });
  apsis_set_step(s.get(), 0.25);
  const double u0[] = {2, 0};
  apsis_start(s.get(), 0, u0);
  EXPECT_EQ(apsis_integrate(s.get(), 0.5), APSIS_OK);
  EXPECT_EQ(data.own, (std::vector<int>{APSIS_OK, APSIS_OK}));
  EXPECT_EQ(data.others, (std::vector<int>{APSIS_INPUT_ERROR, APSIS_INPUT_ERROR}));
  EXPECT_THAT(data.message, HasSubstr("the integrator is in use"));
}

TEST(c_events, refuse_bad_settings) {
  watched data;
  const auto s = of_watched("md-imex-6-3", data);
  const int wrong[] = {2};
  const double decreasing[] = {1, 0.5};
  double u[2], t = 0;
  std::size_t k = 0;
  EXPECT_EQ(apsis_integrate(s.get(), 0.5), APSIS_OK);
  bad_input::expect_refused({
      {[&] { rethrow(apsis_set_events(s.get(), 1, nullptr, nullptr, nullptr)); },
       {"the function of the events is NULL"}},
      {[&] { rethrow(apsis_set_events(s.get(), 1, levels, wrong, nullptr)); },
       {"the direction of an event is 2 (valid: -1, 0, 1)"}},
      {[&] { rethrow(apsis_set_stop_times(s.get(), 2, decreasing)); },
       {"stop times do not increase (number 1"}},
      {[&] { rethrow(apsis_set_stop_times(s.get(), 2, nullptr)); }, {"the list of stop times is NULL"}},
      {[&] { rethrow(apsis_found_event(s.get(), 0, &k, &t)); }, {"there is no event 0 (their number is 0)"}},
      {[&] { rethrow(apsis_state_at(s.get(), 0.1, u)); }, {"the time 0.1 is not in the last step"}},
      {[&] { rethrow(apsis_state_at(s.get(), 0.5, nullptr)); }, {"the place of the state is NULL"}},
      {[&] { rethrow(apsis_state_at(make("md-imex-6-3", 1).get(), 0, u)); },
       {"apsis_start() was not called"}},
  });
}

}  // namespace c_events_test
