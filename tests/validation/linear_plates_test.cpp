// The linear solver of these tests agrees with published values and limits. It supplies
// references of quantities.
#include "linear_plates.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>
#include <validation/quantity.hpp>

namespace linear_plates_test {

namespace {

using apsis::validation::find_quantity;
using apsis::validation::quantity_entry;
using validation_test::extrapolated;
using validation_test::linear_plates;

double shear_stress(double delta) {
  return extrapolated(100, [=](int cells) { return linear_plates(delta, cells).shear_stress(); });
}

double heat_flux(double delta) {
  return extrapolated(100, [=](int cells) { return linear_plates(delta, cells).heat_flux(); });
}

/// Kramers' problem by two plates: the slip, and the velocity defect at a distance from one of them.
struct kramers_problem {
  explicit kramers_problem(int cells) : flow(delta, cells), velocity(flow.velocity()) {
    slip = 0.5 * (std::sqrt(std::numbers::pi) / flow.shear_stress() - delta);
  }

  /// Returns the defect by cubic interpolation between nodes, except at the plate.
  double defect(double distance) const {
    const Eigen::VectorXd x = delta * flow.nodes();
    const auto next = std::lower_bound(x.begin(), x.end(), distance) - x.begin();
    double u = next == 0 ? velocity[0] : 0.0;
    for (auto i = next - 2; next > 0 && i < next + 2; ++i) {
      double weight = 1.0;
      for (auto j = next - 2; j < next + 2; ++j)
        if (j != i) weight *= (distance - x[j]) / (x[i] - x[j]);
      u += weight * velocity[i];
    }
    return distance + slip - (1.0 - u) * (0.5 * delta + slip);
  }

  static constexpr double delta = 24.0;  // the layers change each other by 3e-6
  linear_plates flow;
  Eigen::VectorXd velocity;
  double slip = 0.0;
};

double layer(double distance) {
  return extrapolated(300, [=](int cells) { return kramers_problem(cells).defect(distance); });
}

}  // namespace

TEST(linear_plates, has_the_published_stress) {
  const quantity_entry& couette = find_quantity("couette");
  for (const auto& printed : couette.references) {
    const double delta = std::stod(printed.at.at("delta"));
    if (delta > 20.0) continue;  // needs more cells
    // The tolerance is half a unit of the fourth digit, and the printed digits.
    EXPECT_NEAR(shear_stress(delta), printed.value, 6e-5) << delta;
  }
}

TEST(linear_plates, has_the_limits_of_the_heat_flux) {
  // First collisions at δ -> 0 change the flux by a multiple of δ. At 1e-7 only rounding
  // and quadrature remain.
  EXPECT_NEAR(heat_flux(1e-7), 1.0, 1e-6);
  // Fourier's law is q = (5/4) δ (−dτ/dx) p v₀/δ² with jumps of temperature at both plates. If the layers are
  // thin, 1/flux is linear in δ with slope 4/(5 √π).
  const double slope = (1.0 / heat_flux(24.0) - 1.0 / heat_flux(20.0)) / 4.0;
  EXPECT_NEAR(slope, 4.0 / (5.0 * std::sqrt(std::numbers::pi)), 1e-4);
}

TEST(linear_plates, converges_with_second_order) {
  const double exact = heat_flux(2.0);
  const double coarse = linear_plates(2.0, 25).heat_flux() - exact,
               fine = linear_plates(2.0, 50).heat_flux() - exact;
  EXPECT_NEAR(std::log2(coarse / fine), 2.0, 0.1);
}

TEST(linear_plates, is_the_source_of_the_values_of_heat) {
  for (const auto& reference : find_quantity("heat").references)
    EXPECT_NEAR(heat_flux(std::stod(reference.at.at("delta"))), reference.value, 1e-6);  // printed with six
}

TEST(linear_plates, has_the_published_flow_rates) {
  for (const auto& reference : find_quantity("poiseuille").references) {
    const double delta = std::stod(reference.at.at("delta"));
    const double value =
        extrapolated(400, [=](int cells) { return linear_plates(delta, cells).flow_rate(); });
    // The tolerance is a unit of the last digit, also for δ = 10.
    EXPECT_NEAR(value, reference.value, 1e-6 * reference.value) << delta;
  }
  // A thick gas approaches Stokes' flow.
  EXPECT_NEAR(linear_plates(1e4, 100).flow_rate(), 1e4 / 6.0, 2.0);
}

TEST(linear_plates, has_the_slip_and_the_layer_of_kramers) {
  for (const auto& reference : find_quantity("kramers").references) {
    const auto at = reference.at.find("distance");
    const double value = at == reference.at.end()
                             ? extrapolated(300, [](int cells) { return kramers_problem(cells).slip; })
                             : layer(std::stod(at->second));
    // The tolerance is a unit of the fifth decimal, the last printed one.
    EXPECT_NEAR(value, reference.value, 1e-5) << (at == reference.at.end() ? "slip" : at->second);
  }
}

}  // namespace linear_plates_test
