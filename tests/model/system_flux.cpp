// Fluxes of systems given as formulas: numerical characteristic speeds agree with closed forms.
#include <apsis/model/system_flux.hpp>

#include <apsis/core/errors.hpp>

#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <support/bad_input.hpp>
#include <support/property.hpp>

namespace system_flux_test {

using apsis::system_flux;

namespace {

const system_flux& shallow_water() {
  static const system_flux flux({"h", "q"}, {"q", "q^2/h + g*h^2/2"}, {{"g", 9.81}});
  return flux;
}

const system_flux& euler() {
  static const system_flux flux(
      {"rho", "m", "E"},
      {"m", "m^2/rho + (G - 1)*(E - m^2/(2*rho))", "m/rho*(E + (G - 1)*(E - m^2/(2*rho)))"}, {{"G", 1.4}});
  return flux;
}

void make(const std::vector<std::string>& variables, const std::vector<std::string>& formulas,
          const apsis::formula_constants& constants = {}) {
  const system_flux made(variables, formulas, constants);
}

/// Returns a positive number whose logarithm is uniform.
double between(double lowest, double highest) {
  return lowest * std::pow(highest / lowest, 1e-6 * *rc::gen::inRange(0, 1000001));
}

/// Returns a number in [-size, size], 0 with probability 1/3.
double signed_up_to(double size) {
  return size * *rc::gen::element(0, 1, -1) * 1e-6 * *rc::gen::inRange(0, 1000001);
}

}  // namespace

// In smooth formulas the derivative has an error of at most 1e-11. If one variable is much smaller than the
// others, the rounding error is larger. 1e-8 is a hundredth of the margin in the subcharacteristic condition.
constexpr double tolerance = 1e-8;

TEST(system_flux, has_the_characteristic_speeds_of_shallow_water_from_films_to_oceans) {
  check_property("|q/h| + sqrt(g h)", [] {
    const double h = between(1e-6, 1e4), c = std::sqrt(9.81 * h), velocity = signed_up_to(10.0) * c;
    const double u[] = {h, h * velocity};
    const auto found = shallow_water().characteristic_speeds(u);
    RC_ASSERT(std::abs(found.speed - (std::abs(velocity) + c)) <= tolerance * (std::abs(velocity) + c));
    RC_ASSERT(found.imaginary == 0.0);
  });
}

TEST(system_flux, has_the_characteristic_speeds_of_a_gas_in_any_units) {
  check_property("|v| + sqrt(gamma p/rho)", [] {
    const double rho = between(1e-3, 1e3), p = rho * between(1e-3, 1e7), c = std::sqrt(1.4 * p / rho);
    const double v = signed_up_to(5.0) * c;
    const double u[] = {rho, rho * v, p / 0.4 + 0.5 * rho * v * v};
    const auto found = euler().characteristic_speeds(u);
    RC_ASSERT(std::abs(found.speed - (std::abs(v) + c)) <= tolerance * (std::abs(v) + c));
    RC_ASSERT(found.imaginary <= tolerance * c);
  });
}

TEST(system_flux, has_the_characteristic_speeds_of_more_than_three_variables) {
  // A gas carries two tracers. With that of the contact, the eigenvalue v has multiplicity three.
  const system_flux flux({"rho", "a", "m", "E", "b"}, {"m", "a*m/rho", "m^2/rho + 0.4*(E - m^2/(2*rho))",
                                                       "m/rho*(E + 0.4*(E - m^2/(2*rho)))", "b*m/rho"});
  check_property("|v| + sqrt(gamma p/rho)", [&] {
    const double rho = between(1e-3, 1e3), p = rho * between(1e-3, 1e7), c = std::sqrt(1.4 * p / rho);
    const double v = signed_up_to(5.0) * c;
    const double u[] = {rho, 0.3 * rho, rho * v, p / 0.4 + 0.5 * rho * v * v, -2.0 * rho};
    const auto found = flux.characteristic_speeds(u);
    RC_ASSERT(std::abs(found.speed - (std::abs(v) + c)) <= tolerance * (std::abs(v) + c));
    RC_ASSERT(found.imaginary <= 1e-3 * c);  // the cube root of an error of 1e-9
  });
}

TEST(system_flux, finds_where_a_law_is_not_hyperbolic) {
  // A p-system with a pressure that increases with the volume (van der Waals) has λ² = -p'(v).
  const system_flux flux({"v", "w"}, {"-w", "3*v^2"});
  const double u[] = {0.5, 0.2};
  const auto found = flux.characteristic_speeds(u);
  EXPECT_NEAR(found.imaginary, std::sqrt(3.0), 1e-10);
  const double hyperbolic[] = {-0.5, 0.2};
  EXPECT_EQ(flux.characteristic_speeds(hyperbolic).imaginary, 0.0);
  // The third variable has its own wave. The other two form a rotation.
  const system_flux three({"a", "b", "c"}, {"b", "-a", "5*c"});
  const double any[] = {1.0, 2.0, 3.0};
  EXPECT_NEAR(three.characteristic_speeds(any).imaginary, 1.0, 1e-10);
  EXPECT_NEAR(three.characteristic_speeds(any).speed, 5.0, 1e-10);
}

TEST(system_flux, differentiates_where_slopes_vanish_or_formulas_end) {
  const auto speed = [](const std::string& formula, double u) {
    return system_flux({"u"}, {formula}).characteristic_speeds(&u).speed;
  };
  EXPECT_NEAR(speed("u^3", 0.0), 0.0, 1e-9);
  EXPECT_NEAR(speed("cos(u)", 0.0), 0.0, 1e-12);
  EXPECT_NEAR(speed("7", 2.0), 0.0, 1e-12);
  EXPECT_NEAR(speed("u^2/2", 3.0), 3.0, 1e-11);
  EXPECT_NEAR(speed("exp(u)", 2.0), std::exp(2.0), 1e-9);
  EXPECT_NEAR(speed("1/u", 1e-9), 1e18, 1e9);
  // In Manning's formula for a film of water that has run dry, the slope at 0 is 5/3 u^(2/3) from one side.
  // Its difference over steps of 1e-6 is 1e-4.
  EXPECT_NEAR(speed("u^(5/3)", 0.0), 0.0, 2e-4);
  EXPECT_TRUE(std::isnan(speed("sqrt(u)", -1.0)));
  EXPECT_TRUE(std::isnan(speed("u", std::nan(""))));
}

TEST(system_flux, differentiates_at_values_that_are_rounding_beside_the_data) {
  // The slope at u → 0 is that at 0, whatever the size of u. The speed of the data is 1.
  const auto slope = [](const std::string& formula, double u) {
    return system_flux({"u"}, {formula}).characteristic_speeds(&u, 1.0).speed;
  };
  for (const double u : {5e-324, 2.96e-323, 1e-310, 1e-200, 1e-100, 1e-20, 0.0}) {
    EXPECT_NEAR(slope("u^2/2", u), 0.0, 1e-12) << u;
    EXPECT_NEAR(slope("u^3", u), 0.0, 1e-12) << u;
    EXPECT_NEAR(slope("u + u^2", u), 1.0, 1e-10) << u;
    // F itself has size 1, so a difference over a part of u would be a rounding error.
    EXPECT_NEAR(slope("(u + 1)^2/2", u), 1.0, 1e-10) << u;
    EXPECT_NEAR(slope("exp(u)", u), 1.0, 1e-10) << u;
    EXPECT_NEAR(slope("u^2/(u^2 + 0.5*(1 - u)^2)", u), 0.0, 1e-10) << u;
  }
  // A film of water at rest that has nearly run dry has the speed sqrt(g h).
  for (const double h : {1e-12, 1e-100, 1e-140}) {
    const double u[] = {h, 0.0};
    EXPECT_NEAR(shallow_water().characteristic_speeds(u, 3.0).speed / std::sqrt(9.81 * h), 1.0, 1e-6) << h;
  }
}

TEST(system_flux, of_several_states_equals_that_of_each) {
  const std::vector<double> u = {1.0, 0.5, 2.0, -0.25, 0.125, 3.0, 1e-3, 0.0};
  std::vector<double> together(8), alone(2);
  shallow_water().evaluate(u.data(), 4, together.data());
  for (std::size_t p = 0; p < 4; ++p) {
    shallow_water().evaluate(u.data() + 2 * p, 1, alone.data());
    EXPECT_EQ(together[p], alone[0]);
    EXPECT_EQ(together[4 + p], alone[1]);
    EXPECT_DOUBLE_EQ(alone[1], u[2 * p + 1] * u[2 * p + 1] / u[2 * p] + 0.5 * 9.81 * u[2 * p] * u[2 * p]);
  }
}

TEST(system_flux, has_the_same_speeds_for_many_states_as_for_each) {
  // Some states are at rest, nearly dry, not finite or outside the domain of the law.
  std::vector<std::vector<double>> states;
  for (int k = 0; k < 40; ++k)
    states.push_back(
        {k % 7 == 0 ? 1e-9 : 0.1 + 0.3 * k, k % 5 == 0 ? 0.0 : 0.2 * (k % 11 - 5), 1.0 + k % 13});
  states[3][0] = 0.0;
  states[17][2] = std::nan("");
  states[29][2] = -8.0;
  const auto points = states.size();
  std::vector<double> columns(3 * points);
  for (std::size_t p = 0; p < points; ++p)
    for (std::size_t k = 0; k < 3; ++k) columns[k * points + p] = states[p][k];
  std::vector<system_flux::waves> together(points);
  euler().characteristic_speeds(columns.data(), static_cast<int>(points), 2.0, together.data());
  int undefined = 0;
  for (std::size_t p = 0; p < points; ++p) {
    const auto alone = euler().characteristic_speeds(states[p].data(), 2.0);
    undefined += std::isnan(alone.speed) ? 1 : 0;
    EXPECT_TRUE(together[p].speed == alone.speed ||
                (std::isnan(alone.speed) && std::isnan(together[p].speed)))
        << p;
    EXPECT_EQ(together[p].imaginary, alone.imaginary) << p;
  }
  EXPECT_GE(undefined, 1);
  EXPECT_GT(together[29].imaginary, 0.0);
}

TEST(system_flux, refuses_names_and_numbers_of_formulas_that_do_not_fit) {
  EXPECT_NO_THROW(make({"h", "q"}, {"q", "h*q"}));
  bad_input::expect_refused({
      {[&] { make({"h", "q"}, {"q"}); },
       {"model.flux has 1 formula (each of the 2 variables h, q "
        "has one flux); give 2 formulas"}},
      {[&] { make({}, {}); }, {"model.variables has 0 names"}},
      {[&] { make(std::vector<std::string>(17, "u"), {}); }, {"model.variables has 17 names"}},
      {[&] { make({"h", "h"}, {"h", "h"}); }, {"it occurs twice"}},
      {[&] { make({"x"}, {"1"}); }, {"it is a coordinate or time"}},
      {[&] { make({"t"}, {"1"}); }, {"it is a coordinate or time"}},
      {[&] { make({"pi"}, {"1"}); }, {"formulas have a function or constant of this name"}},
      {[&] { make({"sin"}, {"1"}); }, {"formulas have a function or constant of this name"}},
      {[&] { make({"2h"}, {"1"}); }, {"a name is a letter followed by"}},
      {[&] { make({""}, {"1"}); }, {"a name is a letter followed by"}},
      {[&] { make({"g"}, {"g"}, {{"g", 1.0}}); }, {"a parameter of the case has this name"}},
      {[&] { make({"h"}, {"k"}); }, {"unknown name 'k'"}},
  });
}

}  // namespace system_flux_test
