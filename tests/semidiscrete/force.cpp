// The force −a·∇_v f: positivity, momentum and energy, and order.
#include <apsis/semidiscrete/force.hpp>

#include <apsis/boundary/boundary_registry.hpp>
#include <apsis/core/errors.hpp>
#include <apsis/model/model_registry.hpp>
#include <apsis/scheme/reconstruction_registry.hpp>
#include <apsis/semidiscrete/problem_builder.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>
#include <support/bad_input.hpp>

namespace force_test {

namespace {

using apsis::acceleration;
using apsis::field;
using apsis::position;
using apsis::target;

constexpr int cells = 8;

std::unique_ptr<apsis::model> gas_of(int dimensions, int degrees, int points) {
  auto parts = apsis::default_config(apsis::find_model("bgk"));
  parts.parameters["velocity_dimensions"] = dimensions;
  parts.parameters["degrees_of_freedom"] = degrees;
  parts.velocity.max = 7.0;
  parts.velocity.points = points;
  return apsis::find_model("bgk").make(parts);
}

acceleration constant(std::array<double, 3> a) {
  return {[a](double, const position&) { return a; }, {std::abs(a[0]), std::abs(a[1]), std::abs(a[2])}};
}

/// Returns a periodic problem with a force. It is limited unless the scheme is of first order.
std::unique_ptr<apsis::semidiscrete_problem> problem_of(const apsis::model& gas, const acceleration& of,
                                                        bool limited, const std::string& scheme = "weno5-z") {
  apsis::problem_builder builder(gas);
  builder.on(apsis::grid::line(cells, 0.0, 1.0))
      .with_discretization("finite-difference")
      .with_reconstruction(apsis::find_reconstruction(scheme).make())
      .with_force(of);
  if (limited) builder.with_positivity_limiter();
  return builder.build();
}

/// Returns α u + β T(u).
field combined(apsis::semidiscrete_problem& problem, const field& u, double alpha, double beta) {
  field sum(u.cells(), u.components());
  const target<field, double> to{&sum, alpha, beta, true};
  problem.add_transport(0.0, u, std::span(&to, 1));
  return sum;
}

double least(const field& u) {
  double found = std::numeric_limits<double>::infinity();
  for (int cell = 0; cell < u.cells(); ++cell)
    found = std::min(found, *std::min_element(u.row(cell), u.row(cell) + u.components()));
  return found;
}

/// Returns rows of every size, with zeros and subnormal numbers.
field random_rows(const apsis::model& gas) {
  field u(cells, gas.components());
  for (int cell = 0; cell < cells; ++cell)
    for (int k = 0; k < u.components(); ++k) {
      const int kind = *rc::gen::inRange(0, 6);
      const double size = kind == 0 ? 0.0 : kind == 1 ? 5e-324 : kind == 2 ? 1e-310 : 1.0;
      u.row(cell)[k] =
          size * std::pow(10.0, -*rc::gen::inRange(0, 12)) * (*rc::gen::inRange(0, 1000) / 999.0);
    }
  return u;
}

std::array<double, 3> random_acceleration() {
  std::array<double, 3> a{};
  for (double& one : a) one = *rc::gen::inRange(-300, 300) / 100.0;
  return a;
}

}  // namespace

RC_GTEST_PROP(force, keeps_positivity_up_to_its_forward_euler_step, ()) {
  const int d = *rc::gen::inRange(1, 4);
  const auto gas = gas_of(d, *rc::gen::element(0, 5), d == 3 ? 6 : 10);
  const bool first_order = *rc::gen::arbitrary<bool>();
  const auto problem =
      problem_of(*gas, constant(random_acceleration()), !first_order, first_order ? "upwind1" : "weno5-z");
  const field u = random_rows(*gas);
  const double share = *rc::gen::element(1.0, 0.999, 0.3, 1e-2, 1e-5);
  problem->limit_for_steps(share);
  const double tau = share * problem->forward_euler_step(0.0, u), alpha = *rc::gen::inRange(1, 100) / 99.0;
  RC_ASSERT(least(combined(*problem, u, alpha, alpha * tau)) >= 0.0);
}

TEST(force, loses_positivity_above_its_forward_euler_step) {
  // All mass is at one velocity, next to a zero. Without motion in space the force alone limits the step.
  const auto gas = gas_of(1, 0, 10);
  const auto problem = problem_of(*gas, constant({500.0, 0.0, 0.0}), false, "upwind1");
  field u(cells, gas->components());
  for (int cell = 0; cell < cells; ++cell) u.row(cell)[5] = 1.0;
  const double tau = problem->forward_euler_step(0.0, u);
  EXPECT_GE(least(combined(*problem, u, 1.0, tau)), 0.0);
  // The velocity .7 in the middle does not use the whole bound for |v|/Δx. Of 7 · 8 beside 500/1.4, a sixth
  // of the bound is free.
  EXPECT_LT(least(combined(*problem, u, 1.0, 1.2 * tau)), 0.0);
}

RC_GTEST_PROP(force, gives_momentum_and_energy_to_rounding, ()) {
  // The data are a Maxwellian far from the ends of the lattice, equal in all cells. T then consists of the
  // force alone.
  const int d = *rc::gen::inRange(1, 4);
  const auto gas = gas_of(d, *rc::gen::element(0, 3, 5) < d ? 0 : 5, d == 3 ? 16 : 24);
  const auto a = random_acceleration();
  const auto problem = problem_of(*gas, constant(a), false);
  const auto form = gas->data_forms().front();
  std::vector<double> given = {1.3}, row(static_cast<std::size_t>(gas->components()));
  std::vector<double> u(static_cast<std::size_t>(d));
  for (double& one : u) one = *rc::gen::inRange(-50, 50) / 100.0;
  given.insert(given.end(), u.begin(), u.end());
  given.push_back(0.8);
  RC_ASSERT(form.row(given, row).empty());
  field state(cells, gas->components());
  for (int cell = 0; cell < cells; ++cell) std::copy(row.begin(), row.end(), state.row(cell));
  const field change = combined(*problem, state, 0.0, 1.0);
  std::vector<double> rates(gas->invariants().size());
  gas->invariant_densities(change.row(3), rates.data());
  // The tolerance covers the flux out of the last velocity, which is dropped. It is a thirtieth of f two
  // points before, times |a| |v|².
  const double tolerance = d == 3 ? 2e-6 : 2e-8;
  RC_ASSERT(std::abs(rates[0]) <= 1e-12);
  double power = 0.0;
  for (std::size_t k = 0; k < u.size(); ++k) {
    RC_ASSERT(std::abs(rates[1 + k] - 1.3 * a[k]) <= tolerance);
    power += 1.3 * u[k] * a[k];
  }
  RC_ASSERT(std::abs(rates[1 + u.size()] - power) <= 10.0 * tolerance);
  // The budget has the same rates, over a domain of length 1 and after those of no face.
  for (std::size_t k = 0; k < rates.size(); ++k)
    RC_ASSERT(std::abs(problem->budget_rates()[k] - rates[k]) <= 1e-12);
}

TEST(force, loses_what_the_edges_beyond_the_ends_would_give) {
  // A Maxwellian with u = ±5 in [−7, 7]. Sums of f̂ over all edges give ρ and ρu. Edges beyond the last and
  // before the first velocity have no flux. With f = 0 outside, the missing fluxes depend on the outermost
  // three or two values. The reconstruction has the coefficients 2, −13, 47, 27, −3.
  const int n = 24;
  const double spacing = 14.0 / n;
  for (const double u : {5.0, -5.0, 0.0})
    for (const double a : {1.7, -0.6}) {
      const auto gas = gas_of(1, 3, n);
      const auto problem = problem_of(*gas, constant({a, 0.0, 0.0}), false);
      std::vector<double> row(static_cast<std::size_t>(gas->components()));
      ASSERT_EQ(gas->data_forms().front().row(std::vector<double>{1.3, u, 0.8}, row), "");
      field state(cells, gas->components());
      for (int cell = 0; cell < cells; ++cell) std::copy(row.begin(), row.end(), state.row(cell));
      combined(*problem, state, 0.0, 1.0);
      // Indices and velocities are in the direction of the force.
      const auto f = [&](int j) { return row[static_cast<std::size_t>(a > 0.0 ? j : n - 1 - j)]; };
      const auto edge = [&](int j) { return -7.0 + spacing * (j + 1); };  // behind point j
      const std::vector<std::pair<int, double>> missing = {
          {n - 1, 47.0 * f(n - 1) - 13.0 * f(n - 2) + 2.0 * f(n - 3)},
          {n, -13.0 * f(n - 1) + 2.0 * f(n - 2)},
          {n + 1, 2.0 * f(n - 1)},
          {-1, 27.0 * f(0) - 3.0 * f(1)},
          {-2, -3.0 * f(0)}};
      double momentum = 0.0, energy = 0.0;
      for (const auto& [j, flux] : missing) {
        momentum += a * spacing * flux / 60.0;
        energy += std::abs(a) * spacing * edge(j) * flux / 60.0;
      }
      // The rates of mass, momentum and energy precede the mass into the last velocity, the losses, and ρ|a|.
      const auto rates = problem->budget_rates();
      ASSERT_EQ(rates.size(), 7U);
      EXPECT_NEAR(rates[4], momentum, 1e-13) << u << a;
      EXPECT_NEAR(rates[5], energy, 1e-12) << u << a;
      EXPECT_NEAR(rates[6], 1.3 * std::abs(a), 1e-13);
      EXPECT_NEAR(rates[1] + rates[4], 1.3 * a, 1e-13);
      EXPECT_NEAR(rates[2] + rates[5], 1.3 * u * a, 1e-12);
      if (u * a > 0.0) {
        EXPECT_GT(std::abs(momentum), 1e-3);
      }
      if (u == 0.0) {
        EXPECT_LT(std::abs(momentum) + std::abs(energy), 1e-7);
      }
    }
}

TEST(force, of_first_order_loses_the_energy_of_its_diffusion) {
  // f̂ is f at the point before the edge, where v is half a spacing less than at the edge.
  const auto gas = gas_of(2, 3, 24);
  const std::array<double, 3> a = {0.7, -0.4, 0.0};
  const auto problem = problem_of(*gas, constant(a), false, "upwind1");
  std::vector<double> row(static_cast<std::size_t>(gas->components()));
  ASSERT_EQ(gas->data_forms().front().row(std::vector<double>{1.3, 0.2, 0.5, 0.8}, row), "");
  field state(cells, gas->components());
  for (int cell = 0; cell < cells; ++cell) std::copy(row.begin(), row.end(), state.row(cell));
  combined(*problem, state, 0.0, 1.0);
  const auto rates = problem->budget_rates();
  ASSERT_EQ(rates.size(), 9U);
  // At the last velocities f is 1e-9 of its value at rest.
  EXPECT_NEAR(rates[5], 0.0, 1e-8);
  EXPECT_NEAR(rates[6], 0.0, 1e-8);
  EXPECT_NEAR(rates[7], -0.5 * 14.0 / 24.0 * 1.3 * (0.7 + 0.4), 1e-7);
  EXPECT_NEAR(rates[8], 1.3 * std::hypot(0.7, 0.4), 1e-12);
}

TEST(force, has_fifth_order_along_velocities) {
  // The error is that of the derivative of a Gaussian of variance 1 in the maximum norm.
  const auto error_with = [](int points) {
    const auto gas = gas_of(1, 0, points);
    const auto problem = problem_of(*gas, constant({1.0, 0.0, 0.0}), false);
    field u(cells, gas->components());
    const auto v = gas->speeds(0);
    const auto f = [](double at) { return std::exp(-0.5 * at * at); };
    for (int cell = 0; cell < cells; ++cell)
      for (std::size_t k = 0; k < v.size(); ++k) u.row(cell)[k] = f(v[k]);
    const field change = combined(*problem, u, 0.0, 1.0);
    double largest = 0.0;
    for (std::size_t k = 0; k < v.size(); ++k)
      largest = std::max(largest, std::abs(change.row(2)[k] - v[k] * f(v[k])));
    return largest;
  };
  const double rate = std::log2(error_with(64) / error_with(128));
  EXPECT_NEAR(rate, 5.0, 0.1);
}

TEST(force, does_not_depend_on_how_cells_are_grouped) {
  const auto gas = gas_of(2, 3, 8);
  const acceleration of{
      [](double t, const position& x) { return std::array<double, 3>{x[0] - 0.5, 0.2 * std::sin(t), 0.0}; },
      {0.5, 0.2, 0.0}};
  const auto problem = problem_of(*gas, of, true);
  field u(cells, gas->components());
  for (int cell = 0; cell < cells; ++cell)
    for (int k = 0; k < u.components(); ++k) u.row(cell)[k] = std::abs(std::sin(1.0 + cell + 3.1 * k));
  // With this constant acceleration the cell has the same row.
  const field all = combined(*problem, u, 0.0, 1.0);
  for (const int cell : {0, 3, 7}) {
    const double a = (cell + 0.5) / cells - 0.5;
    const field one = combined(*problem_of(*gas, constant({a, 0.0, 0.0}), true), u, 0.0, 1.0);
    for (int k = 0; k < u.components(); ++k) EXPECT_EQ(all.row(cell)[k], one.row(cell)[k]);
  }
}

TEST(force, refuses_what_it_cannot_hold) {
  const auto gas = gas_of(1, 0, 10);
  field u(cells, gas->components());
  const auto combine = [&](const acceleration& of) { combined(*problem_of(*gas, of, true), u, 1.0, 0.1); };
  bad_input::expect_refused({
      {[&] {
         combine(
             {[](double, const position&) { return std::array<double, 3>{2.0, 0.0, 0.0}; }, {1.0, 0.0, 0.0}});
       },
       {"the acceleration exceeds its bound 1"},
       3},
  });
  const double nan = std::numeric_limits<double>::quiet_NaN();
  bad_input::expect_refused({
      {[&] {
         combine({[&](double, const position&) { return std::array<double, 3>{nan, 0.0, 0.0}; },
                  {1.0, 0.0, 0.0}});
       },
       {"the acceleration exceeds its bound"},
       3},
      {[&] { combine(constant({std::numeric_limits<double>::infinity(), 0.0, 0.0})); },
       {"the largest acceleration is inf"}},
  });
  const auto other =
      apsis::find_model("broadwell").make(apsis::default_config(apsis::find_model("broadwell")));
  EXPECT_THROW(problem_of(*other, constant({1.0, 0.0, 0.0}), false), apsis::input_error);
}

}  // namespace force_test
