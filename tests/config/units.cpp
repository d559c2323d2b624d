// Quantities with units, the table [gas] and Knudsen numbers in a case.
#include <apsis/config/case.hpp>
#include <apsis/config/case_schema.hpp>
#include <apsis/config/quantity.hpp>
#include <apsis/core/errors.hpp>
#include <apsis/model/expression.hpp>
#include <apsis/model/mean_free_path.hpp>
#include <apsis/model/model_registry.hpp>

#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>
#include <support/bad_input.hpp>

namespace units_test {

using namespace apsis;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

namespace {

const std::string in_argon = R"toml([gas]
name = "argon"
pressure = "10 Pa"
temperature = "300 K"
length = "1 mm"
[parameters]
U = "50 m/s"
[model]
name = "shakhov"
velocity_dimensions = 2
[initial]
rho = "4.82e20 1/m^3"
T = "27 degC"
u = [0, "U"]
[space]
cells = 20
domain = ["-1 mm", "1e-3 m"]
[boundary.left]
kind = "diffuse"
T = "350 K"
velocity = [0, "20 m/s"]
[boundary.right]
kind = "diffuse"
T = "1 + 0.1*sin(t)"
[velocity]
max = "1.5 km/s"
points = 16
[time]
method = "md-imex-6-3"
end = "2 us"
safety = 1
steady = "1e3 1/s"
[output]
every = "500 ns"
units = "SI"
)toml";

const std::string no_units = R"toml([model]
name = "bgk"
degrees_of_freedom = 3
collision_rate = "viscosity"
viscosity_exponent = 0.81
[parameters]
kn = 0.1
[space]
cells = 20
[velocity]
max = 8.0
points = 16
[time]
method = "md-imex-6-3"
end = 0.1
safety = 1
)toml";

case_config parse(const std::string& text, const std::vector<std::string>& overrides = {}) {
  return parse_case(text, "c.toml", overrides);
}

std::string changed(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

double number(const std::string& formula, const formula_constants& constants = {}) {
  return expression(formula, {}, {{"x"}, false, constants}).value(0.0);
}

TEST(quantities, are_read_in_units_of_the_si) {
  const std::vector<std::pair<std::string, double>> same = {
      {"0.1 mbar", 10.0},      {"1 atm", 101325.0},      {"760 Torr", 101325.0},   {"2 kPa", 2000.0},
      {"1e3 hPa", 1e5},        {"1 kg/(m s^2)", 1.0},    {"3 N/m^2", 3.0},         {"5 J m^-3", 5.0},
      {"7 kg m^-1 s^-2", 7.0}, {"2 W/(m^2 (m/s))", 2.0}, {" -1.5   MPa ", -1.5e6}, {"4 N / (m*m)", 4.0}};
  for (const auto& [text, value] : same) {
    const quantity q = parse_quantity(text, {});
    EXPECT_EQ(q.unit, dimensions::pressure) << text;
    EXPECT_NEAR(q.value, value, 1e-15 * std::abs(value)) << text;
  }
  EXPECT_EQ(parse_quantity("20 degC", {}).value, 293.15);
  EXPECT_EQ(parse_quantity("20 \u00b0C", {}).unit, dimensions::temperature);
  EXPECT_NEAR(parse_quantity("3 \u00b5m", {}).value, 3e-6, 1e-21);
  EXPECT_NEAR(parse_quantity("3 um", {}).value, 3e-6, 1e-21);
  EXPECT_NEAR(parse_quantity("1 u", {}).value, 1.66053906660e-27, 1e-42);
  EXPECT_EQ(parse_quantity("1e20 1/m^3", {}).unit, dimensions::number_density);
}

TEST(quantities, formulas_are_no_quantities) {
  for (const char* text : {"1 + 2", "1e-3", "x", "2*x", "1 - x", "1 > 2 ? 3 : 4", "", " ", "300", "300K",
                           "K 3", "1 /m", "nan K", "1e999 K", "1 ^2"})
    EXPECT_FALSE(looks_like_quantity(text)) << text;
}

TEST(quantities, wrong_ones_are_refused) {
  const auto parse = [](const std::string& text) { parse_quantity(text, {"c.toml", 3, 4}); };
  for (const auto& [wrong, reason] : std::vector<std::pair<std::string, std::string>>{
           {"3", "c.toml:3:4: '3' is not a quantity"},
           {"3 pa", "did you mean 'Pa'?"},
           {"77 C",
            "c.toml:3:4: unknown unit 'C' (no such symbol, with or without a prefix); did you mean 'degC'? "
            "valid: m, "},
           {"30 deg",
            "c.toml:3:4: unknown unit 'deg' (angles are in degrees and have no unit); write the number "
            "alone"},
           {"80 %", "c.toml:3:4: '80 %' is a percentage (a share is a number from 0 to 1); write 0.8"},
           {"3 W/degC", "degC is part of a unit"},
           {"1e300 MPa MPa", "is not finite"}})
    bad_input::expect_refused({
        {[&, &text = wrong] { parse(text); }, {reason}},
    });
  for (const char* text : {"3 m/", "3 m^", "3 m^x", "3 (m", "3 m)", "3 m//s", "3 ((((((((((m))))))))))",
                           "3 m^99", "3 ((m^9)^9)^9"})
    bad_input::expect_refused({
        {[&] { parse(text); }, {"is not a unit"}},
    });
}

RC_GTEST_PROP(quantities, text_after_a_number_is_read_or_refused, ()) {
  const auto tail =
      *rc::gen::container<std::string>(rc::gen::elementOf(std::string("mskgPaKTor1/^-*() 29u")));
  try {
    const quantity q = parse_quantity("2 " + tail, {});
    RC_ASSERT(std::isfinite(q.value));
  } catch (const input_error&) {
  }
}

TEST(gas, units_become_dimensionless_numbers) {
  const case_config c = parse(in_argon);
  ASSERT_TRUE(c.scales.has_value());
  // These scales are independent of the program: R = k_B/m of argon.
  const double m = 66.3e-27, R = 1.380649e-23 / m, speed = std::sqrt(R * 300.0), time = 1e-3 / speed;
  const auto expect = [](double x, double y) { EXPECT_NEAR(x, y, 1e-12 * std::abs(y)); };
  expect(c.space.domain[0][0], -1.0);
  expect(c.space.domain[0][1], 1.0);
  expect(c.velocity.max, 1500.0 / speed);
  expect(c.time.end, 2e-6 / time);
  expect(*c.time.steady, 1e3 * time);
  expect(c.output.every, 5e-7 / time);
  expect(c.constants.at("U"), 50.0 / speed);
  expect(number(c.prescribed.state.at("rho").front()), 4.82e20 * 1.380649e-23 * 300.0 / 10.0);
  expect(number(c.prescribed.state.at("T").front()), 300.15 / 300.0);
  EXPECT_EQ(c.prescribed.state.at("u").back(), "U");
  expect(number(c.faces[0].values.at("T").front()), 350.0 / 300.0);
  expect(number(c.faces[0].values.at("velocity").back()), 20.0 / speed);
  EXPECT_EQ(c.faces[1].values.at("T").front(), "1 + 0.1*sin(t)");
  // The table of the gas sets the parameters of the model.
  const double mu = 2.117e-5 * std::pow(300.0 / 273.0, 0.81);
  expect(number(c.model.epsilon.text), mu * speed / (10.0 * 1e-3));
  EXPECT_EQ(c.model.options.at("collision_rate"), "viscosity");
  EXPECT_EQ(c.model.parameters.at("viscosity_exponent"), 0.81);
  EXPECT_EQ(c.model.parameters.at("prandtl"), 2.0 / 3.0);
  EXPECT_EQ(c.model.parameters.at("degrees_of_freedom"), 3.0);
}

TEST(gas, accelerations_have_the_unit_of_speed_per_time) {
  const case_config c = parse(in_argon + "[force]\nacceleration = [0, \"1e6 m/s^2\"]\n");
  const double R = 1.380649e-23 / 66.3e-27, expected = 1e6 * 1e-3 / (R * 300.0);
  ASSERT_EQ(c.force.acceleration->size(), 2U);
  EXPECT_NEAR(number(c.force.acceleration->back()), expected, 1e-12 * expected);
  const case_config from_override = parse(in_argon, {"force.acceleration=[0, \"1e6 m/s^2\"]"});
  EXPECT_EQ(from_override.force.acceleration, c.force.acceleration);
}

TEST(gas, a_resolved_case_reads_back_unchanged) {
  const std::string once = to_toml(parse(in_argon)), twice = to_toml(parse(once));
  EXPECT_EQ(once, twice);
  EXPECT_THAT(once, HasSubstr("[gas]\nname = \"argon\"\npressure = \"10 Pa\""));
  const std::string without =
      to_toml(parse(no_units, {"model.knudsen.value=kn", "model.knudsen.mean_free_path=vhs"}));
  EXPECT_EQ(without, to_toml(parse(without)));
}

TEST(gas, pressure_density_and_number_density_are_equivalent) {
  const case_config c = parse(in_argon);
  const double n = 10.0 / (1.380649e-23 * 300.0);
  for (const auto& [key, value] :
       {std::pair<std::string, std::string>{"density", fmt::format("{} kg/m^3", 66.3e-27 * n)},
        {"number_density", fmt::format("{} 1/cm^3", 1e-6 * n)}}) {
    // A key on the command line replaces those that exclude it.
    const case_config other = parse(in_argon, {"gas." + key + "=" + value});
    EXPECT_FALSE(other.gas.pressure.has_value());
    EXPECT_NEAR(other.scales->pressure(), 10.0, 1e-12);
    const double epsilon = number(c.model.epsilon.text);
    EXPECT_NEAR(number(other.model.epsilon.text), epsilon, 1e-12 * epsilon);
  }
}

TEST(gas, of_ones_own_is_described_by_its_values) {
  const std::string own = changed(in_argon, "name = \"argon\"",
                                  "mass = \"40 u\"\nviscosity = \"20 uPa s\"\nviscosity_exponent = 0.7");
  const case_config c = parse(own);
  EXPECT_NEAR(c.scales->viscosity(), 20e-6, 1e-20);  // at the reference temperature
  EXPECT_EQ(c.scales->gas().prandtl, 2.0 / 3.0);
  const case_config hot = parse(own, {"gas.viscosity_temperature=600 K", "gas.prandtl=0.7"});
  EXPECT_NEAR(hot.scales->viscosity(), 20e-6 * std::pow(0.5, 0.7), 1e-18);
  EXPECT_EQ(hot.model.parameters.at("prandtl"), 0.7);
  const case_config named = parse(in_argon, {"gas.viscosity_exponent=0.5"});
  EXPECT_EQ(named.scales->gas().mass, 66.3e-27);
  EXPECT_EQ(named.model.parameters.at("viscosity_exponent"), 0.5);
  EXPECT_EQ(parse(in_argon, {"gas.viscosity_exponent=0"}).model.parameters.at("viscosity_exponent"), 0.0);
}

/// Adds velocities to the overrides that reach beyond those of the following tests.
std::vector<std::string> with_far_velocities(std::vector<std::string> overrides) {
  overrides.insert(overrides.end(), {"velocity.max=15 km/s", "velocity.points=120"});
  return overrides;
}

TEST(gas, a_number_that_lacks_its_unit_causes_a_warning) {
  EXPECT_THAT(parse(in_argon).unit_warnings, IsEmpty());
  EXPECT_THAT(
      parse(changed(in_argon, "T = \"350 K\"", "T = 350")).unit_warnings,
      ElementsAre(
          "c.toml:20:1: 'boundary.left.T' = 350 is 105000 K (a number without a unit is a multiple of "
          "the reference of [gas]); write \"350 K\" if these units are meant"));
  EXPECT_THAT(parse(in_argon, with_far_velocities({"boundary.left.velocity=[0, 50]"})).unit_warnings,
              ElementsAre(AllOf(HasSubstr("override 'boundary.left.velocity=[0, 50]': "),
                                HasSubstr("= 50 is 12497"), HasSubstr("write \"50 m/s\" if"))));
  EXPECT_THAT(parse(in_argon, {"boundary.left.T=350"}).unit_warnings, SizeIs(1));
  // The reference densities are 1.6e-4 kg/m^3 and 2.4e21 1/m^3.
  EXPECT_THAT(parse(in_argon, {"initial.rho=4.82e20"}).unit_warnings,
              ElementsAre(HasSubstr("write \"4.82e+20 1/m^3\" if")));
  EXPECT_THAT(parse(in_argon, {"initial.rho=1.6e-4"}).unit_warnings,
              ElementsAre(HasSubstr("write \"0.00016 kg/m^3\" if")));
  // The number of a constant lies elsewhere.
  EXPECT_THAT(parse(changed(in_argon, "U = \"50 m/s\"", "U = 50"), with_far_velocities({})).unit_warnings,
              ElementsAre(HasSubstr("c.toml:7:1: 'parameters.U' = 50 is 12497")));
}

TEST(gas, a_number_for_all_faces_causes_one_warning) {
  const std::string two_walls = changed(changed(in_argon, "[boundary.left]", "[boundary.all]"),
                                        "[boundary.right]\nkind = \"diffuse\"\n", "[boundary.right]\n");
  EXPECT_THAT(parse(two_walls, with_far_velocities({"boundary.all.velocity=[0, -50]"})).unit_warnings,
              ElementsAre(HasSubstr("'boundary.all.velocity' = -50 is -12497")));
}

TEST(gas, plausible_numbers_without_units_cause_no_warning) {
  EXPECT_THAT(parse(in_argon, with_far_velocities({"boundary.left.T=15", "boundary.left.velocity=[0, 6]",
                                                   "initial.rho=0.01", "initial.u=[0, 0]"}))
                  .unit_warnings,
              IsEmpty());
  // This temperature is 40 times the reference, and has its unit.
  EXPECT_THAT(parse(in_argon, {"boundary.left.T=12000 K"}).unit_warnings, IsEmpty());
  EXPECT_THAT(load_case("gas/micro-channel").unit_warnings, IsEmpty());
}

TEST(knudsen, numbers_of_every_definition_give_epsilon) {
  using std::numbers::pi;
  // Kn/ε follows from λ/L with μ = ε and p = R T = L = 1, independently of the program.
  const std::vector<std::pair<std::string, double>> expected = {
      {"viscosity", std::sqrt(pi / 2.0)},
      {"mean-speed", std::sqrt(8.0 / pi)},
      {"vhs", 2.0 * (7.0 - 1.62) * (5.0 - 1.62) / (15.0 * std::sqrt(2.0 * pi))},
      {"hard-sphere", 3.2 / std::sqrt(2.0 * pi)},
      {"equivalent", std::sqrt(2.0)}};
  EXPECT_EQ(expected.size(), mean_free_paths().size());
  for (const auto& [name, factor] : expected) {
    const auto number_of = [&, &of = name](const std::string& value) {
      const case_config c = parse(
          changed(no_units, "[parameters]",
                  fmt::format("knudsen = {{value = {}, mean_free_path = \"{}\"}}\n[parameters]", value, of)));
      return make_epsilon(c, 1).value(0.5);
    };
    EXPECT_NEAR(number_of("0.1"), 0.1 / factor, 1e-15) << name;
    EXPECT_NEAR(number_of("\"2*kn\""), 0.2 / factor, 1e-15) << name;
    EXPECT_NEAR(number_of("\"kn + x\""), 0.6 / factor, 1e-15) << name;
    EXPECT_EQ(number_of("0"), 0.0) << name;
  }
  EXPECT_NEAR(number(parse(no_units, {"model.rarefaction=3"}).model.epsilon.text),
              1.0 / (3.0 * std::sqrt(2.0)), 1e-16);
  const case_config varying = parse(no_units, {"model.rarefaction=1 + x"});
  EXPECT_NEAR(make_epsilon(varying, 1).value(1.0), 1.0 / (2.0 * std::sqrt(2.0)), 1e-15);
  // Without viscosity_exponent the model uses its default, that of hard spheres.
  const case_config hard = parse(changed(no_units, "viscosity_exponent = 0.81", "rarefaction = 2"));
  EXPECT_EQ(hard.model.parameters.at("viscosity_exponent"), 0.5);
}

TEST(knudsen, a_formula_is_converted_by_arithmetic) {
  const case_config c = parse(no_units, {"model.knudsen.value=kn + x", "model.knudsen.mean_free_path=vhs"});
  // The resolved case has the key as the file gives it, and yields the same numbers when read again.
  EXPECT_THAT(to_toml(c), HasSubstr("knudsen.value = \"kn + x\"\nknudsen.mean_free_path = \"vhs\"\n"));
  EXPECT_THAT(to_toml(c), Not(HasSubstr("epsilon = ")));
  EXPECT_EQ(make_epsilon(parse(to_toml(c)), 1).value(0.3), make_epsilon(c, 1).value(0.3));
  // epsilon replaces the key, on the command line and in a program.
  EXPECT_EQ(make_epsilon(parse(to_toml(c), {"model.epsilon=0.25"}), 1).value(0.3), 0.25);
  case_config changed_by_program = c;
  changed_by_program.model.epsilon = "0.5";
  EXPECT_EQ(make_epsilon(parse(to_toml(changed_by_program)), 1).value(0.3), 0.5);
  // A condition keeps its meaning, and a formula of the greatest length is accepted.
  const case_config jump = parse(no_units, {"model.rarefaction=x < 0.5 ? 1 : 2"});
  EXPECT_EQ(make_epsilon(jump, 1).value(0.25), 1.0 / std::numbers::sqrt2);
  EXPECT_EQ(make_epsilon(jump, 1).value(0.75), 1.0 / (2.0 * std::numbers::sqrt2));
  const std::string longest = "x + 1" + std::string(expression::longest - 5, ' ');
  EXPECT_EQ(make_epsilon(parse(no_units, {"model.rarefaction=\"" + longest + "\""}), 1).value(0.0),
            1.0 / std::numbers::sqrt2);
}

TEST(knudsen, keys_on_the_command_line_replace_those_in_the_file_that_exclude_them) {
  const std::string in_file =
      changed(no_units, "[parameters]", "knudsen = {value = 1, mean_free_path = \"vhs\"}\n[parameters]");
  EXPECT_EQ(parse(in_file, {"model.epsilon=0.25"}).model.epsilon.text, "0.25");
  EXPECT_NE(parse(in_file, {"model.knudsen.value=2"}).model.epsilon.text, parse(in_file).model.epsilon.text);
  EXPECT_NO_THROW(parse(in_file, {"model.rarefaction=2"}));
}

}  // namespace

}  // namespace units_test
