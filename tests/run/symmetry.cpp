// Runs between planes of symmetry agree with periodic runs of twice the length.
#include <apsis/config/case.hpp>
#include <apsis/run/setup.hpp>
#include <apsis/run/simulation.hpp>

#include <cmath>
#include <string>

#include <gtest/gtest.h>

namespace symmetry_test {

namespace {

using apsis::parse_case;
using apsis::simulation;

/// Returns a case with data that are even about x = 0 and x = 1: ρ and T even, u odd.
std::string gas(const std::string& domain, int cells, const std::string& boundary, const std::string& more) {
  return "[model]\nname = \"bgk\"\ndegrees_of_freedom = 3\nepsilon = \"0.01*(2 + cos(pi*x))\"\n"
         "[initial]\nrho = \"1 + 0.4*cos(pi*x)\"\nu = \"0.3*sin(pi*x)\"\nT = \"1 - 0.3*cos(2*pi*x)\"\n"
         "[space]\ncells = " +
         std::to_string(cells) + "\ndomain = " + domain + "\nlimiter = \"positivity\"\nboundary = \"" +
         boundary + "\"\n" + more +
         "[velocity]\nmax = 9\npoints = 32\n"
         "[time]\nmethod = \"md-imex-6-3\"\nend = 0.2\nsafety = 1\n";
}

}  // namespace

TEST(symmetry, at_both_ends_is_half_of_a_periodic_run_with_even_data) {
  for (const std::string formulation : {"finite-volume", "finite-difference"}) {
    const std::string more = "formulation = \"" + formulation + "\"\n";
    simulation half(parse_case(gas("[0.0, 1.0]", 20, "symmetry", more), "half.toml"));
    simulation whole(parse_case(gas("[-1.0, 1.0]", 40, "periodic", more), "whole.toml"));
    EXPECT_TRUE(half.promises().positivity);
    while (!half.finished()) half.advance();
    while (!whole.finished()) whole.advance();
    ASSERT_EQ(half.step(), whole.step());
    const auto a = half.state(), b = whole.state();
    const std::size_t width = static_cast<std::size_t>(half.setup().equation->components());
    ASSERT_EQ(2 * a.size(), b.size());
    double largest = 0.0;
    for (std::size_t k = 0; k < a.size(); ++k)
      largest = std::max(largest, std::abs(a[k] - b[20 * width + k]));
    // The mirrored half differs by rounding errors. WENO weights and some hundred steps amplify them.
    EXPECT_LT(largest, 1e-12) << formulation;
    EXPECT_EQ(half.summary().negative_values, 0);
  }
}

TEST(symmetry, conserves_mass_and_energy_to_rounding) {
  const auto config = parse_case(gas("[0.0, 1.0]", 20, "symmetry", ""), "half.toml");
  simulation run(config);
  const apsis::run_setup setup(config);
  const auto totals = [&] {
    const auto state = run.state();
    const std::size_t width = static_cast<std::size_t>(run.setup().equation->components());
    double sums[3] = {0.0, 0.0, 0.0}, row[3];
    for (std::size_t cell = 0; cell < 20; ++cell) {
      setup.equation->invariant_densities(state.data() + cell * width, row);
      for (int k = 0; k < 3; ++k) sums[k] += row[k];
    }
    return std::pair(sums[0], sums[2]);
  };
  const auto [mass, energy] = totals();
  while (!run.finished()) run.advance();
  const auto [mass_at_end, energy_at_end] = totals();
  // There are six stages in each of some hundred steps.
  EXPECT_NEAR(mass_at_end, mass, 1e-12 * mass);
  EXPECT_NEAR(energy_at_end, energy, 1e-12 * energy);
}

}  // namespace symmetry_test
