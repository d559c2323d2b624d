// Continuation in the rarefaction: the sequence of gases, and starts from the last one.
#include <apsis/steady/rarer_gases.hpp>

#include "gas_problem.hpp"

#include <apsis/core/errors.hpp>

#include <cmath>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace rarer_gases_test {
namespace {

using apsis::rarer_gases;
using factors = std::vector<double>;

double mass(const gas_problem& gas, const apsis::field& f) {
  double sum = 0.0;
  std::vector<double> omega(static_cast<std::size_t>(gas.equation->moment_count()));
  for (int cell = 0; cell < f.cells(); ++cell) {
    gas.equation->moments(f.row(cell), omega.data());
    sum += omega[0];
  }
  return sum;
}

/// Returns a gas between walls of temperatures 1 and T.
gas_problem heated(double delta, double T, const std::string& model = "bgk") {
  const auto equation = make_gas(model, 1, {4.0 * std::sqrt(T) + 4.0, 80}, 1);
  gas_problem gas = gas_between_walls(equation, 1, 40, delta);
  gas.space->with_boundary({0, false}, diffuse_wall(*equation, 1.0))
      .with_boundary({0, true}, diffuse_wall(*equation, T));
  return gas;
}

int iterations(const gas_problem& gas, apsis::field f) {
  const auto problem = gas.space->build();
  apsis::steady_solver solver(*gas.equation, *gas.space, *problem, gas.at_rest());
  // From either start residuals are relative to that of rest.
  solver.relative_residual(gas.at_rest());
  apsis::field rest = gas.at_rest();
  static_cast<void>(solver.iterate(rest));
  solver.restart(0);
  return solver.solve(f).number;
}

}  // namespace

TEST(rarer_gases, begin_with_a_domain_of_few_mean_free_paths) {
  EXPECT_EQ(rarer_gases::factors(0.1), factors{});
  EXPECT_EQ(rarer_gases::factors(10.0), factors{});
  EXPECT_EQ(rarer_gases::factors(11.0), (factors{4.0}));
  EXPECT_EQ(rarer_gases::factors(1414.0), (factors{256.0, 64.0, 16.0, 4.0}));
}

TEST(rarer_gases, end_near_the_steady_state_with_the_mass_of_the_start) {
  const gas_problem gas = heated(500.0, 4.0);
  apsis::field f = gas.at_rest();
  rarer_gases rarer(*gas.equation, *gas.space, {64.0, 16.0, 4.0}, 3);
  int taken = 0;
  for (; !rarer.finished(); ++taken) rarer.iterate(f);
  EXPECT_LT(taken, 60);
  EXPECT_NEAR(mass(gas, f), mass(gas, gas.at_rest()), 1e-12 * 40);
  EXPECT_LT(iterations(gas, f), iterations(gas, gas.at_rest()));
}

TEST(rarer_gases, let_the_solver_settle_where_no_pseudo_time_term_does) {
  const gas_problem gas = heated(1000.0, 100.0, "shakhov");
  const auto problem = gas.space->build();
  apsis::field f = gas.at_rest();
  apsis::steady_solver alone(*gas.equation, *gas.space, *problem, f),
      solver(*gas.equation, *gas.space, *problem, f);
  const auto settles = [&] {
    for (int k = 0; k < 500; ++k)
      if (alone.iterate(f).converged) return true;
    return false;
  };
  bool failed = true;
  do {
    f = gas.at_rest();
    try {
      failed = !settles();
    } catch (const apsis::numerical_error&) {
    }
  } while (failed && alone.begin_again());
  EXPECT_TRUE(failed);
  f = gas.at_rest();
  EXPECT_LE(solver.solve(f).residual, 1e-8);
  EXPECT_NEAR(mass(gas, f), mass(gas, gas.at_rest()), 1e-12 * 40);
}

TEST(rarer_gases, that_do_not_settle_say_so) {
  // Nothing takes the heat of the source.
  const auto equation = make_gas("bgk", 1, {12.0, 24}, 1);
  gas_problem gas = gas_between_walls(equation, 1, 20, 500.0);
  for (const bool upper : {false, true})
    gas.space->with_boundary({0, upper}, apsis::make_boundary("symmetry", *equation, {}));
  gas.space->with_source({[](double, const apsis::position&, std::span<const double>, std::span<double> row) {
                            row[11] = row[12] = 1.0;
                          },
                          true});
  apsis::field f = gas.at_rest();
  rarer_gases rarer(*gas.equation, *gas.space, {64.0}, 3);
  EXPECT_THROW(
      {
        while (!rarer.finished()) rarer.iterate(f);
      },
      apsis::numerical_error);
}

}  // namespace rarer_gases_test
