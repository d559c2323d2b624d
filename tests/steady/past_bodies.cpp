// Steady states past bodies that cut cells.
#include <apsis/core/random_source.hpp>
#include <apsis/steady/macroscopic_system.hpp>
#include <apsis/steady/steady_solver.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <semidiscrete/gas_past_bodies.hpp>

namespace past_bodies_test {
namespace {

using namespace gas_past_bodies_test;

std::vector<double> moments_of(const gas_past_bodies& gas, const field& u) {
  const auto count = static_cast<std::size_t>(gas.equation->moment_count());
  std::vector<double> omega(static_cast<std::size_t>(u.cells()) * count);
  for (int cell = 0; cell < u.cells(); ++cell)
    gas.equation->moments(u.row(cell), omega.data() + static_cast<std::size_t>(cell) * count);
  return omega;
}

/// Returns ℛT of the equilibria.
std::vector<double> rates_of(const gas_past_bodies& gas, const std::vector<double>& omega) {
  const auto count = static_cast<std::size_t>(gas.equation->moment_count());
  field f(gas.mesh().size(), gas.equation->components());
  for (int cell = 0; cell < f.cells(); ++cell)
    if (gas.mesh().solid(cell) < 0)
      gas.equation->equilibrium(omega.data() + static_cast<std::size_t>(cell) * count, f.row(cell));
  return moments_of(gas, gas.step(f, 0.0, 1.0));
}

struct solved {
  field f;
  apsis::steady_iteration last;
  std::unique_ptr<apsis::steady_solver> solver;  ///< keeps the limiter of steady states
};

solved solve(const gas_past_bodies& gas, double tolerance = 1e-8) {
  apsis::steady_options options;
  options.tolerance = tolerance;
  solved found{gas.uniform(), {}, {}};
  found.solver =
      std::make_unique<apsis::steady_solver>(*gas.equation, *gas.builder, *gas.problem, found.f, options);
  found.last = found.solver->solve(found.f);
  return found;
}

const std::vector<outside_function> disc = {ball({0.13, -0.07, 0}, 0.45)};

}  // namespace

TEST(past_bodies, moment_equations_are_the_derivatives_of_transport_in_equilibrium) {
  std::vector<choices> flows = {
      {.bodies = disc, .boundary = "diffuse"},
      {.bodies = disc, .boundary = "outflow", .wall_temperature = 1.3},
      {.bodies = disc, .boundary = "diffuse", .accommodation = 0.4},
      {.bodies = {ball({-0.95, 0.03, 0}, 0.41)}, .boundary = "diffuse"},
      {.bodies = {either(ball({0.07, -1.0, 0}, 0.5), ball({0.07, 1.0, 0}, 0.5))}},
      {.dimensions = 3, .cells = 8, .bodies = {ball({0.1, -0.05, 0.03}, 0.6)}, .boundary = "diffuse"}};
  for (choices& one : flows) {
    one.scheme = "upwind1";
    one.limited = false;
    const gas_past_bodies gas = make(one);
    const apsis::cell_links links(gas.builder->space());
    apsis::macroscopic_system system(*gas.equation, *gas.builder, links);
    const auto omega = some_moments(gas, 0.0);
    // Collisions are so fast that the deviation from equilibrium has no effect.
    system.build(omega, std::vector<double>(static_cast<std::size_t>(gas.mesh().size()), 1e9), 0.0);
    constexpr double step = 1e-5;
    auto direction = some_moments(gas, 0.7);
    std::vector<double> up = omega, down = omega,
                        missing(static_cast<std::size_t>(gas.equation->moment_count()));
    for (std::size_t k = 0; k < omega.size(); ++k) {
      direction[k] -= omega[k];
      up[k] += step * direction[k];
      down[k] -= step * direction[k];
    }
    auto right = rates_of(gas, up);
    const auto below = rates_of(gas, down);
    for (std::size_t k = 0; k < right.size(); ++k) right[k] = (below[k] - right[k]) / (2.0 * step);
    for (const int cell : links.cells())
      for (std::size_t i = 0; i < missing.size(); ++i)
        missing[i] += links.volume(cell) * direction[static_cast<std::size_t>(cell) * missing.size() + i];
    const auto found = system.solve(right, missing);
    // Differences of rows have half of the digits.
    for (const int cell : links.cells())
      for (std::size_t i = 0; i < missing.size(); ++i) {
        const std::size_t k = static_cast<std::size_t>(cell) * missing.size() + i;
        ASSERT_NEAR(found[k], direction[k], 2e-5) << one.boundary << " cell " << cell << " moment " << i;
      }
  }
}

TEST(past_bodies, gases_of_all_densities_and_models_settle) {
  // Without a limiter the gases took 19 to 76 iterations.
  constexpr int most_iterations = 110;
  struct flow {
    choices of;
    int most;  ///< largest number of iterations
  };
  std::vector<flow> flows;
  for (const double epsilon : {1e4, 10.0, 1.0, 0.1, 0.01})
    flows.push_back({{.cells = 16,
                      .bodies = disc,
                      .scheme = "upwind5",
                      .boundary = "diffuse",
                      .limited = false,
                      .wall_temperature = 1.2,
                      .epsilon = epsilon},
                     most_iterations});
  for (const std::string model : {"shakhov", "es-bgk"}) {
    flows.push_back(flows[2]);
    flows.back().of.model = model;
    flows.back().of.wall_temperature = 1.05;  // ten velocities have no target for larger stresses
  }
  flows.push_back(flows[2]);
  flows.back().of.accommodation = 0.5;
  flows.push_back({{.dimensions = 3,
                    .cells = 8,
                    .bodies = {ball({0.1, -0.05, 0.03}, 0.6)},
                    .scheme = "upwind5",
                    .boundary = "diffuse",
                    .limited = false,
                    .wall_temperature = 1.2},
                   most_iterations});
  // With the limiter they took 19 to 71 iterations.
  const std::size_t unlimited = flows.size();
  for (std::size_t k = 0; k < unlimited; ++k) {
    flows.push_back(flows[k]);
    flows.back().of.limited = true;
  }
  for (const auto& [of, most] : flows) {
    const gas_past_bodies gas = make(of);
    const double mass = integrals(gas, gas.uniform())[0];
    const auto [f, last, solver] = solve(gas);
    EXPECT_LE(last.number, most) << of.epsilon << " " << of.model;
    // Fixed points satisfy T + Q = 0, independently of J and the sweeps.
    field r = gas.step(f, 0.0, 1.0);
    const apsis::target<field, double> to{&r, 0.0, 1.0, false};
    gas.problem->add_collision(0.0, f, {&to, 1});
    EXPECT_LT(largest(r), 1e-6) << of.epsilon;
    EXPECT_NEAR(integrals(gas, f)[0], mass, 1e-12 * mass) << of.epsilon;
    for (const auto& group : gas.mesh().cut()->groups())
      for (const int cell : group.cells)
        ASSERT_TRUE(std::equal(f.row(cell), f.row(cell) + f.components(), f.row(group.cells.front())));
    // The heat of the body leaves through the walls.
    const auto rates = gas.problem->budget_rates();
    const std::size_t count = gas.equation->invariants().size();
    double heat = 0.0, sum = 0.0;
    std::size_t end = 0;
    for (const auto& surface : gas.builder->space().budget_surfaces())
      for (std::size_t ends = gas.builder->space().ends_at(surface); ends > 0; --ends, ++end) {
        sum += rates[end * count + count - 1];
        heat += surface.solid >= 0 ? rates[end * count + count - 1] : 0.0;
      }
    EXPECT_GT(heat, 1e-3) << of.epsilon;
    EXPECT_NEAR(sum, 0.0, 1e-5 * heat) << of.epsilon;
  }
}

}  // namespace past_bodies_test
