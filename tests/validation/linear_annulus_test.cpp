// The linear solver between coaxial cylinders agrees with limits. It supplies references of
// the quantity coaxial.
#include "linear_annulus.hpp"

#include <cmath>
#include <numbers>
#include <string>

#include <gtest/gtest.h>
#include <validation/quantity.hpp>

namespace linear_annulus_test {
namespace {

using validation_test::linear_annulus;

/// Returns the limit for many radii by extrapolation of an error of second order.
double extrapolated(double delta, bool torque, int radii = 40) {
  const auto value = [&](int n) {
    const linear_annulus gas(delta, n);
    return torque ? gas.torque() : gas.heat();
  };
  return (4.0 * value(2 * radii) - value(radii)) / 3.0;
}

}  // namespace

TEST(linear_annulus, has_the_references_of_the_quantity) {
  for (const auto& reference : apsis::validation::find_quantity("coaxial").references) {
    const auto quantity = reference.at.find("quantity");
    const bool torque = quantity == reference.at.end() || quantity->second == "torque";
    // The references have five decimals. Extrapolation from 40 and 80 radii has an error of 7e-5 at δ = 10,
    // where layers are a tenth wide.
    EXPECT_NEAR(extrapolated(std::stod(reference.at.at("delta")), torque), reference.value, 1e-4)
        << reference.at.at("delta");
  }
}

TEST(linear_annulus, approaches_free_molecules) {
  // All molecules come from the other wall. Collisions change the flux by a share of order δ.
  const linear_annulus gas(1e-4, 20);
  EXPECT_NEAR(gas.torque(), 1.0, 3e-5);
  EXPECT_NEAR(gas.heat(), 1.0, 6e-5);
}

TEST(linear_annulus, approaches_slip_flow) {
  // Stokes' flow ω = a + b/r² with the slip s r ω' at both walls, s = 1.016191/δ, has b = 1/(3/4 + 9 s/4).
  // The torque is 2b μ over 1/(2√π). Terms of second order in 1/δ are 2.8 % at δ = 10, and a quarter of that
  // at 20.
  const double delta = 20.0;
  const double b = 1.0 / (0.75 + 2.25 * 1.016191 / delta);
  const double exact = 2.0 * std::sqrt(std::numbers::pi) * b / delta;
  EXPECT_NEAR(extrapolated(delta, true, 80), exact, 0.01 * exact);
}

TEST(linear_annulus, is_met_by_the_program_on_few_cells) {
  // The reference has twice as many cells and velocities. The error of second order is thus four times as
  // large here.
  const double torque = apsis::validation::compute_quantity(apsis::validation::find_quantity("coaxial"),
                                                            {"cells=16", "velocity.points=12"});
  EXPECT_NEAR(torque, 0.88123, 0.04);
}

}  // namespace linear_annulus_test
