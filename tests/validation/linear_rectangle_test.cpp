// The linear solvers of a duct and of a square agree with exact values and limits. They supply
// references of quantities.
#include "linear_duct.hpp"
#include "linear_square.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <gtest/gtest.h>
#include <validation/quantity.hpp>

namespace linear_rectangle_test {

namespace {

using apsis::validation::find_quantity;
using apsis::validation::reference_value;
using validation_test::linear_duct;
using validation_test::linear_square;
using validation_test::side;

/// Returns the limit of values f(n), for an error of fourth order in 1/n.
template <class Function>
double limit(int coarse, int fine, const Function& f) {
  const double ratio = std::pow(static_cast<double>(fine) / coarse, 4);
  return (ratio * f(fine) - f(coarse)) / (ratio - 1.0);
}

/// Returns the mean of 1/distance of two points in a rectangle with the sides a and 1.
double inverse_distance(double a) {
  const double diagonal = std::hypot(a, 1.0);
  return (2.0 * (a * a * std::asinh(1.0 / a) + a * std::asinh(a)) +
          2.0 / 3.0 * (a * a * a + 1.0 - diagonal * diagonal * diagonal)) /
         (a * a);
}

/// Returns the mean of u in a viscous fluid in a square duct, −Δu = 1.
double viscous_flow() {
  double sum = 0.0;
  for (int k = 1; k < 200; k += 2) {
    const double q = k * std::numbers::pi;
    sum += std::tanh(0.5 * q) / std::pow(q, 5);
  }
  return 1.0 / 12.0 - 16.0 * sum;
}

/// A point of a side, with its normal into the gas and its share of the length.
struct place {
  double x, y, normal_x, normal_y, length;
};

/// Returns n points on each side of the unit square, those of the top first, at equal distances h in log(x/(1
/// − x)). Near a corner the kernel of two sides depends on the ratio of their distances from it. The density
/// depends on a fractional power of that distance. Both are analytic in the logarithm, so the error falls
/// like exp(−π²/h).
std::vector<place> places_of_square(int n) {
  constexpr double furthest = 20.0;  // drops exp(−20) of each side
  std::vector<place> places;
  const std::array<place, 4> sides = {{{0, 1, 0, -1, 0}, {0, 0, 0, 1, 0}, {0, 0, 1, 0, 0}, {1, 0, -1, 0, 0}}};
  for (place one : sides)
    for (int k = 0; k < n; ++k) {
      const double t = furthest * (2.0 * k + 1.0 - n) / n, x = 1.0 / (1.0 + std::exp(-t));
      (one.normal_x == 0.0 ? one.x : one.y) = x;
      one.length = 2.0 * furthest / n * x / (1.0 + std::exp(t));
      places.push_back(one);
    }
  return places;
}

/// Returns the shear force on the lid of a square of free molecules, from n points on each side. The density
/// ρ of the molecules that leave a side is ½ ∫ ρ cos θ cos θ'/s over the other sides, and (2/√π) ∫ e_x cos θ
/// cos θ'/s of the lid.
double free_molecular_drag(int n) {
  const std::vector<place> places = places_of_square(n);
  const auto size = static_cast<Eigen::Index>(places.size());
  Eigen::MatrixXd kernel(size, size), along_x(size, size);  // cos θ cos θ'/s, times e_x; [to][from]
  for (Eigen::Index i = 0; i < size; ++i)
    for (Eigen::Index j = 0; j < size; ++j) {
      const place &to = places[static_cast<std::size_t>(i)], &from = places[static_cast<std::size_t>(j)];
      const double x = to.x - from.x, y = to.y - from.y, s = std::max(std::hypot(x, y), 1e-12);
      const double leaving = std::max(0.0, x * from.normal_x + y * from.normal_y),
                   arriving = std::max(0.0, -x * to.normal_x - y * to.normal_y);
      kernel(i, j) = from.length * leaving * arriving / (s * s * s);
      along_x(i, j) = kernel(i, j) * x / s;
    }
  const double root = std::sqrt(std::numbers::pi);
  const Eigen::VectorXd thrown = 2.0 / root * along_x.leftCols(n).rowwise().sum();
  // The density is determined up to a constant. Reflections keep it odd in x − 1/2, and each reduces
  // such a density.
  Eigen::VectorXd density = thrown;
  for (int iteration = 0; iteration < 60; ++iteration) density = thrown + 0.5 * kernel * density;
  const Eigen::VectorXd force = along_x.topRows(n) * density;
  double sum = 0.0;
  for (int k = 0; k < n; ++k) sum += places[static_cast<std::size_t>(k)].length * force[k];
  return 1.0 - sum / root;
}

std::string setting(const reference_value& value, const std::string& name, const std::string& otherwise) {
  const auto found = value.at.find(name);
  return found == value.at.end() ? otherwise : found->second;
}

/// Returns the value of a quantity by the linear solvers, extrapolated from two numbers of polynomials.
double linear_value(const std::string& quantity, const reference_value& of, int coarse, int fine) {
  const double delta = std::stod(setting(of, "delta", "1"));
  const double aspect = std::stod(setting(of, "aspect", "1"));
  const bool flow = setting(of, "value", "flow") == "flow";
  const side wall = setting(of, "wall", "bottom") == "left" ? side::left : side::bottom;
  return limit(coarse, fine, [&](int n) {
    if (quantity == "duct") {
      const linear_duct duct(delta, aspect, n);
      return flow ? duct.flow() : duct.creep();
    }
    const linear_square square(delta, n);
    return quantity == "cavity" ? square.drag() : square.heat(wall);
  });
}

}  // namespace

TEST(linear_duct, has_the_flow_of_free_molecules) {
  for (const double aspect : {1.0, 3.0}) {
    const linear_duct duct(0.0, aspect, 4);
    // The solution is one integral. Gauss points compute it to rounding, 100 speeds to 1e-10.
    const double flow = inverse_distance(aspect) * aspect / (2.0 * std::sqrt(std::numbers::pi));
    EXPECT_NEAR(duct.flow(), flow, 1e-9) << aspect;
    EXPECT_NEAR(duct.creep(), 0.5 * flow, 1e-9) << aspect;  // of free molecules
  }
  EXPECT_NEAR(linear_duct(0.0, 1.0, 4).flow(), 0.8387, 5e-5);  // as tables print it
}

TEST(linear_duct, has_the_flow_of_a_viscous_gas) {
  // G = 2 δ (mean of u for −Δu = 1) + slip + O(1/δ).
  const auto flow = [](double delta) { return linear_duct(delta, 1.0, 16).flow(); };
  EXPECT_NEAR((flow(50.0) - flow(40.0)) / 10.0, 2.0 * viscous_flow(), 5e-4);
}

TEST(linear_duct, approaches_plates_when_it_is_wide) {
  // The ends reduce the flow by a constant over the width.
  const auto flow = [](double aspect) { return linear_duct(1.0, aspect, 14).flow(); };
  EXPECT_NEAR(2.0 * flow(12.0) - flow(6.0), 1.538678, 5e-3);
}

TEST(linear_square, has_the_view_factors_of_free_molecules) {
  const linear_square square(0.0, 4);
  EXPECT_NEAR(square.heat(side::bottom), std::numbers::sqrt2 - 1.0, 1e-9);
  for (const side beside : {side::left, side::right})
    EXPECT_NEAR(square.heat(beside), 1.0 - 0.5 * std::numbers::sqrt2, 1e-9);
  EXPECT_NEAR(square.heat(side::top), 0.0, 1e-9);
}

TEST(linear_square, has_the_drag_of_free_molecules) {
  const double drag = free_molecular_drag(80);
  // h = 1/2 gives an error of 8e-9. Ends of length 2e-9 are dropped.
  EXPECT_NEAR(free_molecular_drag(96), drag, 2e-8);
  // The density near a corner is no polynomial. The errors with 6 and 10 are 2e-5 and
  // 3e-6, extrapolated 5e-8.
  EXPECT_NEAR(limit(6, 10, [](int n) { return linear_square(0.0, n).drag(); }), drag, 5e-7);
}

TEST(linear_square, loses_no_heat) {
  const linear_square square(3.0, 6);
  double sum = 0.0;
  for (const side each : {side::left, side::right, side::bottom, side::top}) sum += square.heat(each);
  EXPECT_NEAR(sum, 1.0, 1e-9);
  EXPECT_NEAR(square.heat(side::left), square.heat(side::right), 1e-12);
}

TEST(linear_square, converges_with_fourth_order) {
  // The reference 1.125090 is extrapolated from 12 and 16 polynomials.
  const double coarse = linear_square(1.0, 4).drag() - 1.125090,
               fine = linear_square(1.0, 8).drag() - 1.125090;
  EXPECT_NEAR(std::log2(coarse / fine), 4.4, 0.5);
}

TEST(linear_square, is_the_source_of_a_value_of_the_cavity) {
  const reference_value& one = find_quantity("cavity").references.at(1);
  // The tolerance covers half of the last digit, and 4e-6 of the extrapolation.
  EXPECT_NEAR(linear_value("cavity", one, 6, 10), one.value, 9e-6);
}

TEST(linear_duct, is_the_source_of_values_of_duct) {
  for (const auto& reference : find_quantity("duct").references) {
    if (setting(reference, "delta", "1") != "1") continue;
    // The tolerance covers half of the last digit, and 2e-6 of the extrapolation.
    EXPECT_NEAR(linear_value("duct", reference, 8, 12), reference.value, 2.5e-6);
  }
}

TEST(SLOW_linear_duct, is_the_source_of_all_values) {
  for (const auto& reference : find_quantity("duct").references)
    EXPECT_NEAR(linear_value("duct", reference, 16, 20), reference.value, 2e-6);
}

TEST(SLOW_linear_square, is_the_source_of_all_values) {
  // The order is between 4 and 5, so the error is 1e-5 at delta = 10. The value 0.0001 stands for free
  // molecules, with an error of 3e-5.
  for (const std::string quantity : {"cavity", "enclosure"})
    for (const auto& reference : find_quantity(quantity).references)
      EXPECT_NEAR(linear_value(quantity, reference, 12, 16), reference.value, 4e-5) << quantity;
}

}  // namespace linear_rectangle_test
