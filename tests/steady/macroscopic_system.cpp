// The linearised moment equations: conserved sums, and refused systems.
#include <apsis/steady/macroscopic_system.hpp>

#include "gas_problem.hpp"

#include <apsis/core/errors.hpp>

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace macroscopic_system_test {
namespace {

using moments = apsis::macroscopic_system::moments;

/// A gas at rest on a line of 12 cells between two boundaries.
struct line {
  gas_problem gas;
  apsis::cell_links links;
  apsis::macroscopic_system system;
  moments omega;

  explicit line(gas_problem given, bool first_order = false)
      : gas(std::move(given)),
        links(gas.space->space()),
        system(*gas.equation, *gas.space, links, first_order) {
    const apsis::field f = gas.at_rest();
    for (int cell = 0; cell < f.cells(); ++cell) {
      std::vector<double> here(static_cast<std::size_t>(gas.equation->moment_count()));
      gas.equation->moments(f.row(cell), here.data());
      omega.insert(omega.end(), here.begin(), here.end());
    }
    system.build(omega, std::vector<double>(static_cast<std::size_t>(f.cells()), 10.0), 0.0);
  }
};

gas_problem between(const std::string& left, const std::string& right) {
  const auto equation = make_gas("bgk", 1, {5.0, 10}, 2);
  gas_problem gas = gas_between_walls(equation, 1, 12, 5.0);
  const auto side = [&](const std::string& kind) {
    if (kind == "diffuse") return diffuse_wall(*equation, 1.0);
    if (kind == "inflow") return apsis::make_boundary("inflow", *equation, {{"rho", {1.0}}, {"T", {1.0}}});
    return apsis::make_boundary(kind, *equation, {});
  };
  gas.space->with_boundary({0, false}, side(left)).with_boundary({0, true}, side(right));
  return gas;
}

using flags = std::vector<bool>;

}  // namespace

TEST(macroscopic_system, keeps_the_sums_that_no_boundary_changes) {
  EXPECT_EQ(line(between("diffuse", "diffuse")).system.conserved(), (flags{true, false, false, false}));
  EXPECT_EQ(line(between("symmetry", "symmetry")).system.conserved(), (flags{true, false, true, true}));
  EXPECT_EQ(line(between("inflow", "diffuse")).system.conserved(), (flags{false, false, false, false}));
}

TEST(macroscopic_system, sees_that_a_force_gives_momentum_and_energy) {
  const apsis::acceleration a{[](double, const apsis::position&) { return std::array{0.0, 0.1, 0.0}; },
                              {0.0, 0.1, 0.0}};
  gas_problem gas = between("symmetry", "symmetry");
  gas.space->with_force(a);
  EXPECT_EQ(line(std::move(gas)).system.conserved(), (flags{true, false, false, false}));
}

TEST(macroscopic_system, adds_the_mass_that_is_missing) {
  line gas(between("diffuse", "diffuse"));
  const moments change = gas.system.solve(moments(gas.omega.size(), 0.0), {0.6, 0.0, 0.0, 0.0});
  // At rest between equal walls only the density changes, by the same amount everywhere. Differences of rows
  // have half of the digits.
  for (std::size_t cell = 0; cell < 12; ++cell) {
    EXPECT_NEAR(change[4 * cell], 0.05, 1e-7) << cell;
    EXPECT_NEAR(change[4 * cell + 3], 0.075, 1e-7) << cell;
  }
}

TEST(macroscopic_system, has_the_profile_of_viscous_shear) {
  // A steady source s of y-momentum between walls at rest gives μ u″ = −s with μ = T/10. The slip at the
  // walls is of order Kn. A parabola of this curvature has slip too.
  const double h = 1.0 / 12.0;
  const auto second_differences = [&](bool first_order) {
    const line gas(between("diffuse", "diffuse"), first_order);
    moments source(gas.omega.size(), 0.0), found;
    for (std::size_t cell = 0; cell < 12; ++cell) source[4 * cell + 2] = 1e-3;
    const moments change = gas.system.solve(source, {0.0, 0.0, 0.0, 0.0});
    for (std::size_t cell = 4; cell < 8; ++cell)
      found.push_back((change[4 * (cell + 1) + 2] - 2.0 * change[4 * cell + 2] + change[4 * (cell - 1) + 2]) /
                      (h * h));
    return found;
  };
  // The tolerance has the size of the third-order dissipation |v|h³/12.
  for (const double second : second_differences(false)) EXPECT_NEAR(second, -1e-2, 2e-3);
  // First-order upwind fluxes add the viscosity ⟨|v|⟩h/2 = √(2/π)h/2, here a third of the viscosity
  // of the gas.
  const double upwind = std::sqrt(2.0 / std::numbers::pi) * h / 2.0;
  for (const double second : second_differences(true)) EXPECT_NEAR(second, -1e-3 / (0.1 + upwind), 5e-4);
}

TEST(macroscopic_system, names_the_cell_without_equilibrium) {
  line gas(between("diffuse", "diffuse"));
  gas.omega[4 * 7 + 3] = -1.0;
  try {
    gas.system.build(gas.omega, std::vector<double>(12, 10.0), 0.0);
    FAIL();
  } catch (const apsis::numerical_error& failure) {
    EXPECT_EQ(failure.site().cell, 7);
  }
}

}  // namespace macroscopic_system_test
