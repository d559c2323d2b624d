// The first step of runs with a tolerance in the C interface.
#include <cmath>
#include <limits>
#include <vector>

#include <c/ode.hpp>
#include <gtest/gtest.h>
#include <support/bad_input.hpp>

namespace c_first_step_test {
namespace {

using namespace c_interface;

/// The model with a tolerance that allows long steps, and the steps it takes.
struct recorded {
  ode of{1.0};  // first, because the callbacks of ode.hpp read it
  std::vector<double> steps;
};

int record(long long, double, double dt, size_t, const double*, void* data) {
  static_cast<recorded*>(data)->steps.push_back(dt);
  return 0;
}

integrator of_recorded(recorded& data) {
  auto s = of_ode("md-imex-6-3", data.of);
  apsis_set_observer(s.get(), record);
  apsis_set_tolerance(s.get(), 0, 1e-2);
  return s;
}

}  // namespace

TEST(c_first_step, is_the_given_one) {
  for (const double first : {1e-5, 1e-2}) {
    recorded data;
    const auto s = of_recorded(data);
    EXPECT_EQ(apsis_set_first_step(s.get(), first), APSIS_OK);
    EXPECT_EQ(apsis_integrate(s.get(), 1), APSIS_OK) << apsis_error_message();
    EXPECT_EQ(data.steps.front(), first);
    EXPECT_GT(data.steps.size(), 1U);
  }
}

TEST(c_first_step, is_determined_by_the_problem_once_it_is_removed) {
  recorded usual, removed;
  const auto a = of_recorded(usual), b = of_recorded(removed);
  apsis_set_first_step(b.get(), 1e-5);
  EXPECT_EQ(apsis_set_first_step(b.get(), 0), APSIS_OK);
  for (const auto* s : {&a, &b}) EXPECT_EQ(apsis_integrate(s->get(), 1), APSIS_OK) << apsis_error_message();
  EXPECT_EQ(removed.steps, usual.steps);
}

TEST(c_first_step, is_shortened_by_the_error_the_longest_step_and_the_interval) {
  recorded data;
  const auto s = of_recorded(data);
  const double u0[] = {2, 0};
  const auto first = [&](double tolerance, double longest, double t1) {
    data.steps.clear();
    apsis_set_tolerance(s.get(), 0, tolerance);
    apsis_set_step(s.get(), longest);
    apsis_start(s.get(), 0, u0);
    EXPECT_EQ(apsis_integrate(s.get(), t1), APSIS_OK) << apsis_error_message();
    return data.steps.front();
  };
  apsis_set_first_step(s.get(), 0.5);
  EXPECT_EQ(first(10, 0, 1), 0.5);      // no error of this size
  EXPECT_EQ(first(10, 0, 0.25), 0.25);  // the interval
  EXPECT_EQ(first(10, 0.125, 1), 0.125);
  EXPECT_LT(first(1e-8, 0, 1), 0.5);
  EXPECT_GT(apsis_count(s.get(), APSIS_REJECTED_STEPS), 0);
}

TEST(c_first_step, belongs_to_the_start_alone) {
  recorded data;
  const auto s = of_recorded(data);
  apsis_set_first_step(s.get(), 1e-5);
  EXPECT_EQ(apsis_integrate(s.get(), 0.5), APSIS_OK) << apsis_error_message();
  data.steps.clear();
  apsis_set_safety(s.get(), 1);  // restarts the control of step lengths
  EXPECT_EQ(apsis_integrate(s.get(), 1), APSIS_OK) << apsis_error_message();
  EXPECT_GT(data.steps.front(), 1e-3);
  data.steps.clear();
  const double u0[] = {2, 0};
  apsis_start(s.get(), 0, u0);
  EXPECT_EQ(apsis_integrate(s.get(), 1), APSIS_OK) << apsis_error_message();
  EXPECT_EQ(data.steps.front(), 1e-5);
}

TEST(c_first_step, is_refused_unless_it_is_a_length_of_a_run_with_a_tolerance) {
  recorded data;
  const auto s = of_recorded(data);
  const auto with = [&data](const auto& change) {
    return [&data, change] {
      const auto one = of_recorded(data);
      apsis_set_first_step(one.get(), 0.1);
      change(one.get());
      rethrow(apsis_integrate(one.get(), 1));
    };
  };
  const double infinity = std::numeric_limits<double>::infinity();
  bad_input::expect_refused({
      {[&] { rethrow(apsis_set_first_step(s.get(), -0.5)); },
       {"the first step is -0.5 (a length is needed)", "0 to remove it"}},
      {[&] { rethrow(apsis_set_first_step(s.get(), std::nan(""))); }, {"the first step is nan"}},
      {[&] { rethrow(apsis_set_first_step(s.get(), infinity)); }, {"the first step is inf"}},
      {[&] { rethrow(apsis_set_first_step(nullptr, 0.5)); }, {"the integrator is NULL"}},
      {with([](auto* one) {
         apsis_set_tolerance(one, 0, 0);
         apsis_set_step(one, 0.1);
       }),
       {"a first step is given without a tolerance", "apsis_set_tolerance()"}},
      {with([](auto* one) {
         apsis_set_relaxation_time(one, relaxation_time);
         apsis_set_graded_start(one, 2);
       }),
       {"a first step and a graded start are given"}},
  });
}

}  // namespace c_first_step_test
