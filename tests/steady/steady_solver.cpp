// Steady states agree with published values, theory, and the time integrator.
#include <apsis/steady/steady_solver.hpp>

#include "gas_problem.hpp"

#include <apsis/core/errors.hpp>
#include <apsis/exec/parallel.hpp>
#include <apsis/integrate/stepper.hpp>
#include <apsis/method/method.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <support/bad_input.hpp>

namespace steady_solver_test {
namespace {

using apsis::field;

apsis::velocity_config half_ranges(int across, int along) {
  apsis::velocity_config velocity;
  velocity.max = 6.0;
  velocity.points = std::vector<int>{across, along};
  velocity.set = {"graded", "uniform"};
  return velocity;
}

struct solved {
  field f;
  apsis::steady_iteration last;
  std::vector<double> rates;  ///< that the gas receives at the ends
};

solved solve(const gas_problem& gas, const apsis::steady_options& options = {}) {
  const auto problem = gas.space->build();
  solved found{gas.at_rest(), {}, {}};
  apsis::steady_solver solver(*gas.equation, *gas.space, *problem, found.f, options);
  found.last = solver.solve(found.f);
  found.rates.assign(problem->budget_rates().begin(), problem->budget_rates().end());
  return found;
}

gas_problem couette(double delta, double u, int cells = 40, const std::string& model = "bgk",
                    const std::string& scheme = "upwind5") {
  const auto equation = make_gas(model, 1, half_ranges(32, 12), 2);
  gas_problem gas = gas_between_walls(equation, 1, cells, delta, scheme);
  gas.space->with_boundary({0, false}, diffuse_wall(*equation, 1.0, -u))
      .with_boundary({0, true}, diffuse_wall(*equation, 1.0, u));
  return gas;
}

double total_mass(const gas_problem& gas, const field& f) {
  double sum = 0.0;
  std::vector<double> omega(static_cast<std::size_t>(gas.equation->moment_count()));
  for (int cell = 0; cell < f.cells(); ++cell) {
    gas.equation->moments(f.row(cell), omega.data());
    sum += omega[0];
  }
  return sum / f.cells();
}

double largest_difference(const field& a, const field& b) {
  double largest = 0.0;
  for (int cell = 0; cell < a.cells(); ++cell)
    for (int k = 0; k < a.components(); ++k)
      largest = std::max(largest, std::abs(a.row(cell)[k] - b.row(cell)[k]));
  return largest;
}

}  // namespace

TEST(steady_solver, finds_the_stress_of_couette_flow_at_every_rarefaction) {
  // Willis (Phys. Fluids 5, 1962) and Loyalka computed the stress of linear BGK over its free-molecular
  // value, with four digits. 40 cells and 32 velocities are accurate to 5e-4.
  for (const auto& [delta, published] : {std::pair{0.01, 0.9914},
                                         {0.1, 0.9258},
                                         {1.0, 0.6007},
                                         {10.0, 0.1473},
                                         {20.0, 0.08045},
                                         {100.0, 0.01737}}) {
    const double u = 0.01;
    const solved found = solve(couette(delta, u));
    // Rates of the lower end precede those of the upper one: mass, momentum across and along, energy.
    const double stress = -found.rates[4 + 2] / (2.0 * u / std::sqrt(2.0 * std::numbers::pi));
    EXPECT_NEAR(stress, -published, 6e-4 * published) << delta;
    EXPECT_LE(found.last.number, 60) << delta;
  }
}

TEST(steady_solver, keeps_mass_and_balances_what_walls_give) {
  for (const double delta : {0.1, 10.0, 1000.0}) {
    const gas_problem gas = couette(delta, 0.5, 20);
    const solved found = solve(gas, {.tolerance = 1e-10});
    EXPECT_NEAR(total_mass(gas, found.f), 1.0, 1e-12) << delta;
    for (const std::size_t k : {std::size_t{0}, std::size_t{2}, std::size_t{3}})
      EXPECT_NEAR(found.rates[k], -found.rates[4 + k], 1e-9) << delta << " " << k;
  }
}

TEST(steady_solver, finds_a_state_that_the_time_integrator_leaves_as_it_is) {
  // The steps belong to a method whose steady state is that of the equation. Their change shows the distance
  // of the state from theirs. The same steps change the state at rest by 1e-3.
  for (const char* model : {"bgk", "shakhov", "es-bgk"}) {
    const gas_problem gas = couette(5.0, 0.1, 10, model);
    const auto problem = gas.space->build();
    const auto march = [&](field f) {
      apsis::stepper steps(apsis::find_method("forward-backward-euler"), *problem);
      const double dt = 0.2 * problem->forward_euler_step(0.0, f);
      for (int n = 0; n < 40; ++n) steps.step(0.0, dt, f);
      return f;
    };
    const solved found = solve(gas, {.tolerance = 1e-12});
    // Stages predict relaxing moments with the accuracy of sums over the velocities, 1e-9
    // for twelve velocities.
    EXPECT_LT(largest_difference(march(found.f), found.f), model == std::string("bgk") ? 1e-13 : 5e-10)
        << model;
    EXPECT_GT(largest_difference(march(gas.at_rest()), gas.at_rest()), 1e-3) << model;
  }
}

TEST(steady_solver, finds_the_same_state_from_any_start_of_the_same_mass) {
  const gas_problem gas = couette(3.0, 0.3, 12);
  const solved from_rest = solve(gas, {.tolerance = 1e-12});
  field f = gas.at_rest();
  // The start has a jet in the middle and cold gas at the walls.
  std::vector<double> omega = {1.0, 0.2, -0.5, 0.0};
  for (int cell = 0; cell < f.cells(); ++cell) {
    omega[3] = 0.5 * (0.29 + 3.0 * (cell % 11 == 0 ? 0.6 : 1.2));
    gas.equation->equilibrium(omega.data(), f.row(cell));
  }
  const auto problem = gas.space->build();
  apsis::steady_solver solver(*gas.equation, *gas.space, *problem, f, {.tolerance = 1e-12});
  solver.solve(f);
  EXPECT_LT(largest_difference(f, from_rest.f), 1e-10);
}

TEST(steady_solver, conserves_the_mass_of_the_start_and_not_of_iterates) {
  const gas_problem gas = couette(2.0, 0.2, 10);
  const auto problem = gas.space->build();
  const field start = gas.at_rest();
  apsis::steady_solver solver(*gas.equation, *gas.space, *problem, start);
  field f = start;
  for (int cell = 0; cell < f.cells(); ++cell)
    for (int k = 0; k < f.components(); ++k) f.row(cell)[k] *= 1.3;
  solver.solve(f);
  EXPECT_NEAR(total_mass(gas, f), 1.0, 1e-12);
}

namespace {

struct enclosed {
  const char* model;
  int space, velocities;
  double delta;
};
void PrintTo(const enclosed& of, std::ostream* out) {
  *out << of.model << " D" << of.space << " d" << of.velocities << " delta " << of.delta;
}
std::vector<enclosed> all_enclosed() {
  std::vector<enclosed> all;
  for (const char* model : {"bgk", "shakhov", "es-bgk"})
    for (const auto& [space, velocities] : {std::pair{1, 1}, {1, 3}, {2, 2}, {3, 3}})
      for (const double delta : {0.1, 3.0, 100.0}) all.push_back({model, space, velocities, delta});
  return all;
}

class heated : public testing::TestWithParam<enclosed> {};

}  // namespace

TEST_P(heated, gas_between_walls_of_two_temperatures_settles) {
  const auto [model, space, velocities, delta] = GetParam();
  const auto equation = make_gas(model, space, {5.5, space == 3 ? 8 : 10}, velocities);
  gas_problem gas = gas_between_walls(equation, space, space == 1 ? 20 : space == 2 ? 8 : 5, delta);
  for (int d = 0; d < space; ++d)
    for (const bool upper : {false, true})
      gas.space->with_boundary({d, upper}, diffuse_wall(*equation, d == 0 && upper ? 1.3 : 0.9));
  const solved found = solve(gas);
  EXPECT_LE(found.last.number, space == 1 ? 60 : 120);
  EXPECT_NEAR(total_mass(gas, found.f), 1.0, 1e-12);
  // At every rarefaction heat enters at the hot wall and leaves at the others.
  const std::size_t count = equation->invariants().size(),
                    ends = found.rates.size() / count;  // the last number is that of a force
  double sum = 0.0, received = 0.0;
  for (std::size_t end = 0; end < ends; ++end) {
    const double energy = found.rates[end * count + count - 1];
    sum += energy;
    received += std::max(energy, 0.0);
  }
  EXPECT_GT(received, 1e-4);
  EXPECT_NEAR(sum, 0.0, 1e-6 * received);
}

INSTANTIATE_TEST_SUITE_P(gases, heated, testing::ValuesIn(all_enclosed()));

TEST(steady_solver, settles_with_few_velocities_whose_equilibria_have_a_heat_flux) {
  // Eight velocities miss 5 % of a Maxwellian. A moving one then has a heat flux. The target of Shakhov's
  // model thus differs from the equilibrium.
  for (const char* model : {"bgk", "shakhov", "es-bgk"})
    for (const int space : {2, 3}) {
      apsis::velocity_config velocity{5.0, 8};
      velocity.set = {"graded"};
      const auto equation = make_gas(model, space, velocity, 3);
      gas_problem gas = gas_between_walls(equation, space, space == 2 ? 8 : 5, 5.0);
      for (int d = 0; d < space; ++d)
        for (const bool upper : {false, true})
          gas.space->with_boundary({d, upper}, diffuse_wall(*equation, 1.0, d == 0 && upper ? 0.15 : 0.0));
      EXPECT_LE(solve(gas, {.tolerance = 1e-6}).last.number, 30) << model << space;
    }
}

TEST(steady_solver, settles_far_from_equilibrium_from_rest) {
  // The walls have temperatures 1 and 9. The plates move with twice the speed of sound relative
  // to each other.
  for (const double delta : {0.1, 10.0, 1000.0}) {
    const auto equation = make_gas("bgk", 1, {18.0, 48}, 1);
    gas_problem gas = gas_between_walls(equation, 1, 30, delta);
    gas.space->with_boundary({0, false}, diffuse_wall(*equation, 1.0))
        .with_boundary({0, true}, diffuse_wall(*equation, 9.0));
    EXPECT_LE(solve(gas).last.number, 100) << delta;
    const auto moving = make_gas("bgk", 1, {8.0, 24}, 2);
    gas_problem plates = gas_between_walls(moving, 1, 30, delta);
    plates.space->with_boundary({0, false}, diffuse_wall(*moving, 1.0, -1.3))
        .with_boundary({0, true}, diffuse_wall(*moving, 1.0, 1.3));
    EXPECT_LE(solve(plates).last.number, 60) << delta;
  }
}

TEST(steady_solver, does_not_depend_on_the_number_of_threads) {
  const auto equation = make_gas("bgk", 2, {5.0, 8}, 2);
  gas_problem gas = gas_between_walls(equation, 2, 6, 2.0);
  for (int d = 0; d < 2; ++d)
    for (const bool upper : {false, true})
      gas.space->with_boundary({d, upper}, diffuse_wall(*equation, 1.0, d == 0 && upper ? 0.2 : 0.0));
  const solved one = solve(gas);
  apsis::set_threads(4);
  const solved four = solve(gas);
  apsis::set_threads(1);
  EXPECT_EQ(largest_difference(one.f, four.f), 0.0);
  EXPECT_EQ(one.last.number, four.last.number);
}

TEST(steady_solver, works_on_averages_and_with_every_reconstruction) {
  const solved points = solve(couette(1.0, 0.05, 20));
  for (const char* scheme : {"upwind1", "weno5-js", "weno5-z", "teno5"}) {
    const solved found = solve(couette(1.0, 0.05, 20, "bgk", scheme));
    const double accuracy = scheme == std::string("upwind1") ? 2e-2 : 2e-5;
    EXPECT_NEAR(found.rates[6], points.rates[6], accuracy * std::abs(points.rates[6])) << scheme;
  }
  gas_problem gas = couette(1.0, 0.05, 20);
  gas.space->with_discretization("finite-volume");
  for (const char* place : {"gauss", "centres"}) {
    gas.space->with_collisions_at(place);
    EXPECT_NEAR(solve(gas).rates[6], points.rates[6], 1e-4 * std::abs(points.rates[6])) << place;
  }
}

TEST(steady_solver, ends_at_once_in_the_steady_state) {
  const auto equation = make_gas("bgk", 1, half_ranges(16, 10), 2);
  gas_problem gas = gas_between_walls(equation, 1, 10, 1.0);
  for (const bool upper : {false, true}) gas.space->with_boundary({0, upper}, diffuse_wall(*equation, 1.0));
  const solved found = solve(gas);
  EXPECT_EQ(found.last.number, 0);
  EXPECT_TRUE(found.last.rounding);
}

TEST(steady_solver, ends_where_a_flow_never_settles) {
  // A force along specularly reflecting walls accelerates the gas for ever.
  const auto equation = make_gas("bgk", 1, {6.0, 12}, 2);
  gas_problem gas = gas_between_walls(equation, 1, 10, 5.0);
  for (const bool upper : {false, true})
    gas.space->with_boundary({0, upper}, apsis::make_boundary("symmetry", *equation, {}));
  gas.space->with_force(
      {[](double, const apsis::position&) { return std::array{0.0, 0.1, 0.0}; }, {0.0, 0.1, 0.0}});
  EXPECT_THROW(solve(gas, {.iterations = 1000}), apsis::numerical_error);
}

TEST(steady_solver, says_what_it_cannot_do) {
  gas_problem gas = couette(1.0, 0.1, 10);
  const field start = gas.at_rest();
  const auto solve = [&](const apsis::problem_builder& space, const apsis::steady_options& options) {
    const auto problem = space.build();
    apsis::steady_solver solver(*gas.equation, space, *problem, start, options);
    field f = start;
    solver.solve(f);
  };
  bad_input::expect_refused({
      {[&] { solve(*gas.space, {.iterations = 3}); }, {"no steady state in 3 iterations"}, 3},
  });
  apsis::problem_builder limit(*gas.space);
  limit.with_epsilon([](const apsis::position& x) { return x[0] < 0.5 ? 0.0 : 1.0; });
  bad_input::expect_refused({
      {[&] { solve(limit, {}); }, {"epsilon is 0 in some cell"}},
  });
}

}  // namespace steady_solver_test
