// Collisions given by their rate alone in the C interface: differences replace the derivatives.
#include <apsis/integrate/difference_derivatives.hpp>
#include <apsis/integrate/evolution.hpp>
#include <apsis/integrate/newton_problem.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <c/ode.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace c_differences_test {
namespace {

using namespace c_interface;
using state = std::vector<double>;
using rule = apsis::step_rule<double>;

/// Q_i = 100 (u_{i−1} − 2u_i + u_{i+1} − bend u_i³), and the number of its calls.
struct chain {
  double bend = 1.0;
  long long calls = 0;

  void value(std::span<const double> u, std::span<double> out) {
    ++calls;
    const auto at = [&u](std::size_t i) { return i < u.size() ? u[i] : 0.0; };
    for (std::size_t i = 0; i < u.size(); ++i)
      out[i] = 100 * (at(i - 1) - 2 * u[i] + at(i + 1) - bend * u[i] * u[i] * u[i]);
  }
};

int value(size_t, size_t n, const double* u, double* q, void* data) {
  static_cast<chain*>(data)->value({u, n}, {q, n});
  return 0;
}

constexpr std::size_t length = 12;

integrator of_chain(const char* name, chain& data, bool sparse) {
  auto s = make(name, length);
  apsis_set_data(s.get(), &data);
  EXPECT_EQ(apsis_set_rate(s.get(), value), APSIS_OK);
  if (sparse) {
    std::vector<std::size_t> rows, columns;
    for (std::size_t i = 0; i + 1 < length; ++i) {
      rows.insert(rows.end(), {i, i + 1});
      columns.insert(columns.end(), {i + 1, i});
    }
    EXPECT_EQ(apsis_set_sparsity(s.get(), rows.size(), rows.data(), columns.data()), APSIS_OK);
  }
  const state u0(length, 0.5);
  EXPECT_EQ(apsis_start(s.get(), 0, u0.data()), APSIS_OK);
  return s;
}

/// The measure of errors of apsis_set_tolerance(1e-4, 1e-6).
double weighted(const state& u, const state& v) {
  double largest = 0;
  for (std::size_t i = 0; i < u.size(); ++i)
    largest = std::max(largest, std::abs(u[i] - v[i]) / (1e-6 + 1e-4 * std::abs(u[i])));
  return largest;
}

}  // namespace

TEST(c_differences, give_the_bits_and_the_calls_of_difference_derivatives) {
  for (const char* name : {"md-imex-8-3-mixed", "ark-548-2", "extrapolated-euler-5"})
    for (const bool sparse : {false, true})
      for (const bool adaptive : {false, true}) {
        chain data, counted;
        const auto g = [&counted](std::span<const double> u, std::span<double> out) {
          counted.value(u, out);
        };
        apsis::newton_problem problem(apsis::no_transport{}, apsis::difference_derivatives<decltype(g)>(g));
        if (sparse) problem.with_sparsity(apsis::sparsity_pattern::banded(length, 1, 1));
        const auto s = of_chain(name, data, sparse);
        std::optional<apsis::step_tolerance<state, double>> tolerance;
        if (adaptive) {
          problem.with_tolerances(apsis::component_tolerances<double>(1e-4, 1e-6));
          tolerance = {1.0, weighted, std::nullopt};
          apsis_set_tolerance(s.get(), 1e-4, 1e-6);
        } else {
          apsis_set_step(s.get(), 1.0 / 32);
        }
        apsis::evolution march(apsis::find_integrator(name), problem,
                               adaptive ? rule::unlimited() : rule::fixed(1.0 / 32), tolerance);
        march.start(0, state(length, 0.5));
        march.advance(0.25);
        EXPECT_EQ(apsis_integrate(s.get(), 0.25), APSIS_OK) << apsis_error_message();
        const std::string of = name + std::string(sparse ? ", sparse" : "") + (adaptive ? ", adaptive" : "");
        EXPECT_EQ(unknowns_of(s, length), march.u()) << of;
        EXPECT_EQ(data.calls, counted.calls) << of;
        EXPECT_EQ(apsis_count(s.get(), APSIS_RATE_EVALUATIONS), data.calls) << of;
        EXPECT_EQ(apsis_count(s.get(), APSIS_JACOBIAN_EVALUATIONS), 0) << of;
        EXPECT_EQ(apsis_count(s.get(), APSIS_PRODUCT_EVALUATIONS), 0) << of;
      }
}

TEST(c_differences, take_two_calls_for_each_unknown_or_group_of_columns) {
  // Stages of a linear Q take the same corrections with both matrices. One matrix belongs to each step.
  const auto calls = [](bool sparse, long long& steps) {
    chain data{.bend = 0.0};
    const auto s = of_chain("extrapolated-euler-4", data, sparse);
    apsis_set_tolerance(s.get(), 1e-4, 1e-6);
    EXPECT_EQ(apsis_integrate(s.get(), 0.25), APSIS_OK) << apsis_error_message();
    EXPECT_EQ(apsis_count(s.get(), APSIS_REJECTED_STEPS), 0);
    steps = apsis_count(s.get(), APSIS_STEPS);
    return data.calls;
  };
  long long of_full = 0, of_sparse = 0;
  const long long full = calls(false, of_full), sparse = calls(true, of_sparse);
  EXPECT_EQ(of_full, of_sparse);
  EXPECT_GT(of_full, 2);
  EXPECT_EQ(full - sparse, of_full * 2 * (12 - 3));  // a tridiagonal pattern has three groups
}

namespace {

/// Robertson's reaction.
int reaction(size_t, size_t, const double* y, double* q, void*) {
  q[0] = -0.04 * y[0] + 1e4 * y[1] * y[2];
  q[2] = 3e7 * y[1] * y[1];
  q[1] = -q[0] - q[2];
  return 0;
}
int jacobian_of_reaction(size_t, size_t, const double* y, double* j, void*) {
  const double rows[] = {-0.04,
                         1e4 * y[2],
                         1e4 * y[1],  //
                         0.04,
                         -1e4 * y[2] - 6e7 * y[1],
                         -1e4 * y[1],  //
                         0,
                         6e7 * y[1],
                         0};
  std::copy(rows, rows + 9, j);
  return 0;
}

struct solved {
  state u;
  long long steps, rates, jacobians;
};

solved solve_reaction(const char* name, bool differenced, double t1) {
  const auto s = make(name, 3);
  apsis_set_rate(s.get(), reaction);
  if (!differenced) apsis_set_jacobian(s.get(), jacobian_of_reaction);
  const double absolute[] = {1e-10, 1e-14, 1e-10}, u0[] = {1, 0, 0};
  apsis_set_tolerances(s.get(), 1e-6, absolute);
  apsis_start(s.get(), 0, u0);
  EXPECT_EQ(apsis_integrate(s.get(), t1), APSIS_OK) << apsis_error_message();
  const auto count = [&s](apsis_counter which) { return apsis_count(s.get(), which); };
  return {unknowns_of(s, 3), count(APSIS_STEPS), count(APSIS_RATE_EVALUATIONS),
          count(APSIS_JACOBIAN_EVALUATIONS)};
}

}  // namespace

TEST(c_differences, solve_robertsons_problem_like_the_exact_jacobian) {
  for (const char* name : {"extrapolated-euler-5", "ark-436", "md-imex-10-3-mixed", "imdrk-9-5"})
    for (const double t1 : {40.0, 1e6}) {
      const solved exact = solve_reaction(name, false, t1), differenced = solve_reaction(name, true, t1);
      EXPECT_EQ(differenced.steps, exact.steps) << name;
      // Stages end at a thousandth of the relative tolerance 1e-6. Differences have ten digits, which the
      // last two methods need in Q̇.
      for (std::size_t i = 0; i < 3; ++i)
        EXPECT_NEAR(differenced.u[i], exact.u[i], 1e-9 * exact.u[i]) << name << ", t = " << t1 << ", " << i;
      EXPECT_NEAR(differenced.u[0] + differenced.u[1] + differenced.u[2], 1.0, 1e-12) << name;
      // The example cvRoberts_dns of SUNDIALS prints these digits. Errors of steps are up to the tolerance.
      if (t1 == 40.0) {
        EXPECT_NEAR(differenced.u[0], 0.7158271, 2e-6) << name;
        EXPECT_NEAR(differenced.u[1], 9.185535e-6, 1e-10) << name;
      }
    }
}

TEST(c_differences, of_three_unknowns_take_six_calls_in_place_of_a_jacobian) {
  for (const char* name : {"extrapolated-euler-5", "ark-436"}) {
    const solved exact = solve_reaction(name, false, 40), differenced = solve_reaction(name, true, 40);
    EXPECT_EQ(differenced.rates - exact.rates, 6 * exact.jacobians) << name;
    EXPECT_GE(exact.jacobians, exact.steps) << name;
    EXPECT_EQ(differenced.jacobians, 0) << name;
  }
}

TEST(c_differences, replace_a_jacobian_that_is_removed) {
  const auto s = make("ark-436", 3);
  apsis_set_rate(s.get(), reaction);
  apsis_set_jacobian(s.get(), jacobian_of_reaction);
  const double absolute[] = {1e-10, 1e-14, 1e-10}, u0[] = {1, 0, 0};
  apsis_set_tolerances(s.get(), 1e-6, absolute);
  apsis_start(s.get(), 0, u0);
  EXPECT_EQ(apsis_integrate(s.get(), 20), APSIS_OK) << apsis_error_message();
  const long long before = apsis_count(s.get(), APSIS_JACOBIAN_EVALUATIONS);
  EXPECT_EQ(apsis_set_jacobian(s.get(), nullptr), APSIS_OK);
  EXPECT_EQ(apsis_integrate(s.get(), 40), APSIS_OK) << apsis_error_message();
  EXPECT_EQ(apsis_count(s.get(), APSIS_JACOBIAN_EVALUATIONS), before);
  EXPECT_NEAR(apsis_state(s.get())[0], 0.7158271, 2e-6);  // as above
}

TEST(c_differences, of_blocks_are_those_of_problems_of_their_own) {
  static const double epsilon[] = {1e-4, 0.3};
  const auto of_block = [](size_t block, size_t n, const double* u, double* q, void*) {
    ode of{epsilon[block]};
    return rate(block, n, u, q, &of);
  };
  const auto of_all = [](double t, size_t n, const double* u, double* out, void* data) {
    for (size_t i = 0; i < n; i += 2) transport(t, 2, u + i, out + i, data);
    return 0;
  };
  const double u0[] = {2, 0, 2, 0};
  const auto all = make("md-imex-6-3", 4);
  apsis_set_transport(all.get(), of_all);
  apsis_set_rate(all.get(), of_block);
  apsis_set_block_size(all.get(), 2);
  apsis_set_step(all.get(), 1.0 / 64);
  apsis_start(all.get(), 0, u0);
  ASSERT_EQ(apsis_integrate(all.get(), 1), APSIS_OK) << apsis_error_message();
  state expected;
  for (const double one : epsilon) {
    ode data{one};
    const auto alone = of_ode("md-imex-6-3", data);
    apsis_set_step(alone.get(), 1.0 / 64);
    apsis_set_stage(alone.get(), nullptr);
    ASSERT_EQ(apsis_integrate(alone.get(), 1), APSIS_OK) << apsis_error_message();
    const state differenced = unknowns_of(alone, 2);
    expected.insert(expected.end(), differenced.begin(), differenced.end());
    // By closed formulas. Differences have ten digits of Q', and their error in Q̇ moves the stage by less.
    const auto closed = of_ode("md-imex-6-3", data);
    apsis_set_step(closed.get(), 1.0 / 64);
    ASSERT_EQ(apsis_integrate(closed.get(), 1), APSIS_OK) << apsis_error_message();
    for (std::size_t i = 0; i < 2; ++i)
      EXPECT_NEAR(differenced[i], apsis_state(closed.get())[i], 1e-8) << one;
  }
  EXPECT_EQ(unknowns_of(all, 4), expected);
}

TEST(c_differences, of_a_collision_of_time_agree_with_its_products) {
  // u' = −50 (u³ − sin³t) + cos t has the solution sin t.
  const auto timed = [](double t, size_t, size_t, const double* u, double* q, void*) {
    q[0] = -50 * (u[0] * u[0] * u[0] - std::pow(std::sin(t), 3)) + std::cos(t);
    return 0;
  };
  const auto product = [](double, size_t, size_t, const double* u, const double* x, double* jx, void*) {
    jx[0] = -150 * u[0] * u[0] * x[0];
    return 0;
  };
  for (const char* name : {"imdrk-3-3", "ark-436"}) {
    const auto end = [&](bool differenced) {
      const auto s = make(name, 1);
      apsis_set_timed_rate(s.get(), timed);
      if (!differenced) apsis_set_timed_product(s.get(), product);
      apsis_set_step(s.get(), 1.0 / 64);
      const double u0 = std::sin(0.5);
      apsis_start(s.get(), 0.5, &u0);
      EXPECT_EQ(apsis_integrate(s.get(), 1.5), APSIS_OK) << apsis_error_message();
      return apsis_state(s.get())[0];
    };
    const double differenced = end(true), exact = end(false);
    EXPECT_NEAR(differenced, exact, 1e-10) << name;         // ten digits of the derivative
    EXPECT_NEAR(differenced, std::sin(1.5), 1e-5) << name;  // the error of order 3 with steps of 1/64
  }
}

TEST(c_differences, report_rates_that_are_not_defined_beside_a_state) {
  // A concentration begins at 0, and the rate is defined for nonnegative ones.
  const auto status = [](const char* name, apsis_rate_function* q) {
    const auto s = make(name, 2);
    apsis_set_rate(s.get(), q);
    apsis_set_tolerance(s.get(), 1e-4, 1e-8);
    const double u0[] = {1, 0};
    apsis_start(s.get(), 0, u0);
    return apsis_integrate(s.get(), 1);
  };
  const auto rejecting = [](size_t, size_t, const double* u, double* q, void*) {
    q[1] = u[0] - u[1];
    q[0] = -q[1];
    return u[1] < 0 ? 3 : 0;
  };
  const auto undefined = [](size_t, size_t, const double* u, double* q, void*) {
    q[1] = u[0] - u[1] + 0 * std::sqrt(u[1]);
    q[0] = -q[1];
    return 0;
  };
  const auto failing = [](size_t, size_t, const double* u, double* q, void*) {
    q[0] = q[1] = 0;
    return u[1] < 0 ? -4 : 0;
  };
  for (apsis_rate_function* q : {+rejecting, +undefined}) {
    // Its first stage begins at 0.
    EXPECT_EQ(status("extrapolated-euler-4", q), APSIS_NUMERICAL_ERROR);
    EXPECT_THAT(apsis_error_message(),
                testing::HasSubstr("the derivative of the stage equation is not finite"));
    // Its first implicit stage begins at a positive number.
    EXPECT_EQ(status("ark-436", q), APSIS_OK) << apsis_error_message();
  }
  EXPECT_EQ(status("extrapolated-euler-4", failing), APSIS_CALLBACK_ERROR);
  EXPECT_THAT(apsis_error_message(), testing::HasSubstr("the callback 'rate' failed (it returned -4)"));
}

TEST(c_differences, are_not_taken_where_a_solver_an_explicit_method_or_a_flow_suffices) {
  for (const char* name : {"md-imex-6-3", "dop853", "exponential-2"}) {
    ode data{0.1};
    const auto s = of_ode(name, data);
    apsis_set_step(s.get(), 1.0 / 64);
    EXPECT_EQ(apsis_integrate(s.get(), 1), APSIS_OK) << apsis_error_message();
    EXPECT_EQ(apsis_count(s.get(), APSIS_NEWTON_ITERATIONS), 0) << name;
  }
}

}  // namespace c_differences_test
