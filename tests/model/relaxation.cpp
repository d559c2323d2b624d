// The relaxation system satisfies its equations. Slopes of its fluxes are accurate.
#include <apsis/model/model_registry.hpp>
#include <apsis/model/scalar_flux.hpp>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <support/property.hpp>

namespace relaxation_test {

namespace {

std::unique_ptr<apsis::model> make(const std::string& flux, double speed) {
  auto config = apsis::default_config(apsis::find_model("relaxation"));
  config.options["flux"] = flux;
  config.parameters["speed"] = speed;
  return apsis::find_model("relaxation").make(config);
}

const apsis::relaxation_model& as_relaxation(const apsis::model& m) {
  return dynamic_cast<const apsis::relaxation_model&>(m);
}

std::string complaint(const std::string& flux, double speed, double low, double high) {
  const double lowest[] = {low, 0.0}, highest[] = {high, 0.0};
  const auto found = make(flux, speed)->check_supported_range(lowest, highest);
  return found.key.empty() ? "" : found.key + ": " + found.problem;
}

}  // namespace

TEST(scalar_flux, slopes_are_the_limits_of_difference_quotients) {
  const std::vector<std::string> fluxes = {"linear", "burgers", "buckley-leverett", "sin(u)/2", "exp(-u^2)"};
  for (const auto& text : fluxes) {
    const apsis::scalar_flux F(text, 0.7, 0.25);
    check_property(text, [&] {
      const double u = 1e-3 * *rc::gen::inRange(-2000, 2001), h = 1e-5;
      // The difference quotient has second order: h² F'''/6, with F''' up to a few hundred for
      // the steepest flux.
      RC_ASSERT(std::abs(F.derivative(u) - (F(u + h) - F(u - h)) / (2.0 * h)) < 1e-7);
    });
  }
}

TEST(scalar_flux, a_formula_equals_the_flux_of_the_same_name) {
  const apsis::scalar_flux named("buckley-leverett", 0.0, 0.5),
      formula("u^2/(u^2 + 0.5*(1 - u)^2)", 0.0, 0.0);
  for (double u = -0.5; u <= 1.5; u += 0.01) {
    EXPECT_NEAR(named(u), formula(u), 4e-16);                       // a few rounding errors
    EXPECT_NEAR(named.derivative(u), formula.derivative(u), 1e-9);  // h⁴ F⁽⁵⁾/30: h 1.4e-3, F⁽⁵⁾ up to 2e3
  }
}

TEST(scalar_flux, the_fastest_wave_inside_an_interval_is_found) {
  // For Buckley–Leverett |F'| is 0 at both ends. Bisection solves the cubic equation F'' = 0 here.
  const double M = 0.5;
  const auto curvature = [M](double u) {
    const double d = u * u + M * (1 - u) * (1 - u);
    return (1 - 2 * u) * d - 2 * u * (1 - u) * (2 * u - 2 * M * (1 - u));
  };
  double low = 0.1, high = 0.9;
  for (int k = 0; k < 60; ++k) (curvature(0.5 * (low + high)) > 0.0 ? low : high) = 0.5 * (low + high);
  const apsis::scalar_flux F("buckley-leverett", 0.0, M);
  const auto found = F.fastest(0.0, 1.0);
  EXPECT_NEAR(found.u, low, 1e-6);  // the function is flat at its maximum
  EXPECT_NEAR(found.speed, F.derivative(low), 1e-14);
  EXPECT_EQ(apsis::scalar_flux("burgers", 0, 1).fastest(-2.0, 1.0).speed, 2.0);
  EXPECT_EQ(apsis::scalar_flux("burgers", 0, 1).fastest(0.5, 0.5).speed, 0.5);
}

TEST(scalar_flux, slopes_of_formulas_have_steps_of_the_size_of_the_data) {
  // Data may have any unit: F(u) = s Φ(u/s) has the slope Φ'(u/s).
  for (const double s : {1e-200, 1e-12, 1.0, 1e9}) {
    const apsis::scalar_flux F("s*(u/s)^2/((u/s)^2 + 0.5*(1 - u/s)^2)", 0.0, 0.0, {{"s", s}}),
        unit("buckley-leverett", 0.0, 0.5);
    const auto found = F.fastest(0.0, s), expected = unit.fastest(0.0, 1.0);
    EXPECT_NEAR(found.speed, expected.speed, 1e-9) << s;
    EXPECT_NEAR(found.u / s, expected.u, 1e-4) << s;  // flat at the maximum
  }
  // The data are 1 and 0 with tails that underflow.
  EXPECT_NEAR(apsis::scalar_flux("u^2/2", 0.0, 0.0).fastest(2.96e-323, 1.0).speed, 1.0, 1e-10);
}

TEST(relaxation, transport_and_collision_are_those_of_the_paper_in_u1_and_u2) {
  check_property("characteristic variables", [] {
    const double a = *rc::gen::element(0.5, 1.0, 3.0), F = 0.4;
    const auto made = make("0.4 + 0*u", a);
    const auto& m = as_relaxation(*made);
    const auto number = [] { return 1e-3 * *rc::gen::inRange(-1000, 1001); };
    const double u1 = number(), u2 = number(), u1_x = number(), u2_x = number();
    const auto to_f = [a](double p, double q) {
      return std::vector<double>{0.5 * (p + q / a), 0.5 * (p - q / a)};
    };
    const auto from_f = [&m](const std::vector<double>& f) {
      std::vector<double> u(2);
      m.macroscopic(f.data(), u.data());
      return u;
    };
    // −v f_x in (u1, u2) is −(u2_x, a² u1_x).
    auto moved = to_f(u1_x, u2_x);
    for (std::size_t k = 0; k < 2; ++k) moved[k] *= -m.speeds(0)[k];
    RC_ASSERT(std::abs(from_f(moved)[0] + u2_x) < 1e-15);
    RC_ASSERT(std::abs(from_f(moved)[1] + a * a * u1_x) < 1e-14);
    // C (E − f) in (u1, u2) is (0, F − u2).
    const auto f = to_f(u1, u2);
    double omega;
    std::vector<double> q(2);
    m.moments(f.data(), &omega);
    RC_ASSERT(m.equilibrium(&omega, q.data()));
    for (std::size_t k = 0; k < 2; ++k) q[k] = m.rate(&omega) * (q[k] - f[k]);
    RC_ASSERT(std::abs(from_f(q)[0]) < 1e-15);
    RC_ASSERT(std::abs(from_f(q)[1] - (F - u2)) < 1e-14);
  });
}

TEST(relaxation, refuses_fluxes_that_violate_the_subcharacteristic_condition) {
  EXPECT_EQ(complaint("burgers", 1.0, -1.0, 1.0), "");  // equality is allowed
  EXPECT_EQ(complaint("sin(u)", 1.0, -3.0, 3.0), "");
  EXPECT_EQ(
      complaint("burgers", 1.0, -1.01, 0.5),
      "model.speed: model.speed = 1 is too small for the flux \"burgers\" (|F'(u)| = 1.01 at u = -1.01, "
      "which the data reach, and the subcharacteristic condition is |F'| <= speed); give at least 1.01");
  // The maximum is inside the interval, with |F'| = 0 at its ends.
  EXPECT_NE(complaint("buckley-leverett", 2.0, 0.0, 1.0).find("give at least 2.081"), std::string::npos);
  EXPECT_NE(complaint("log(u)", 1.0, -1.0, 1.0).find("model.flux: "), std::string::npos);
  EXPECT_NE(complaint("1/u", 1.0, -1.0, 1.0), "");
}

TEST(relaxation, the_speed_that_a_message_suggests_is_accepted) {
  check_property("speed", [] {
    const double k = 1e-3 * *rc::gen::inRange(1100, 90000);
    const std::string flux = std::to_string(k) + "*sin(u)";
    const std::string message = complaint(flux, 1.0, -1.0, 1.0);
    const double advised = std::stod(message.substr(message.rfind(' ')));
    RC_ASSERT(complaint(flux, advised, -1.0, 1.0).empty());
    RC_ASSERT(advised < k * 1.0011);  // four digits, rounded up
  });
}

TEST(relaxation, an_infinite_flux_is_refused_with_its_state) {
  const auto made = make("1/(u - 0.5)", 1.0);
  const auto& m = as_relaxation(*made);
  const double omega = 0.5;
  double e[2];
  EXPECT_FALSE(m.equilibrium(&omega, e));
  EXPECT_EQ(m.why_inadmissible(&omega), "the flux is inf at u1 = 0.5");
}

}  // namespace relaxation_test
