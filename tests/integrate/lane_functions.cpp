// Elementary functions in lanes against those of the standard library.
#include <apsis/integrate/lanes.hpp>

#include <array>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <integrate/random.hpp>
#include <support/property.hpp>

namespace lane_functions_test {
namespace {

using apsis::lanes;
constexpr double infinity = std::numeric_limits<double>::infinity();

struct function {
  const char* name;
  lanes (*of_lanes)(const lanes&);
  long double (*exact)(long double);
  double (*of_one)(double);
};
const function functions[] = {
    {"exp", [](const lanes& x) { return exp(x); }, [](long double x) { return std::exp(x); },
     [](double x) { return std::exp(x); }},
    {"log", [](const lanes& x) { return apsis::lane_arithmetic::log(x); },
     [](long double x) { return std::log(x); }, [](double x) { return std::log(x); }},
    {"sin", [](const lanes& x) { return sin(x); }, [](long double x) { return std::sin(x); },
     [](double x) { return std::sin(x); }},
    {"cos", [](const lanes& x) { return cos(x); }, [](long double x) { return std::cos(x); },
     [](double x) { return std::cos(x); }},
};

/// The distance of y from the exact value, in units of the last place of the exact value.
double units(double y, long double exact) {
  const double rounded = std::abs(static_cast<double>(exact));
  const double unit = std::nextafter(rounded, infinity) - rounded;
  return static_cast<double>(std::abs(static_cast<long double>(y) - exact) / static_cast<long double>(unit));
}

}  // namespace

TEST(lane_functions, are_within_three_units_in_the_last_place) {
  // Arguments of all sizes, and those next to zeros of the functions and to the ends of reduced intervals.
  check_property("functions of lanes", [] {
    const double pi = 3.14159265358979323846;
    std::array<double, 8> x;
    for (double& one : x) {
      const double size = random_input::magnitude(-12, 5.9), sign = random_input::one_in(2) ? -1.0 : 1.0;
      const double near = random_input::integer(-600000, 600000) * (pi / 4);
      one = random_input::one_in(2) ? sign * size : near + sign * random_input::magnitude(-9, -1);
      if (random_input::one_in(4)) one = 1.0 + sign * random_input::magnitude(-9, -1);
    }
    for (const function& f : functions) {
      std::array<double, 8> from = x;
      for (double& one : from) {
        if (f.of_one == functions[0].of_one) one = std::fmod(one, 700.0);
        if (f.of_one == functions[1].of_one) one = one == 0.0 ? 1.0 : std::abs(one);
      }
      const lanes y = f.of_lanes(lanes::load(from.data()));
      for (std::size_t k = 0; k < 8; ++k)
        EXPECT_LE(units(y[k], f.exact(from[k])), 3.0) << f.name << " of " << from[k];
    }
  });
}

TEST(lane_functions, have_the_values_of_the_standard_library_out_of_range) {
  const double smallest = std::numeric_limits<double>::denorm_min(),
               largest = std::numeric_limits<double>::max();
  for (const double special : {infinity, -infinity, std::nan(""), 0.0, -0.0, smallest, -1.0, 1e22, largest,
                               -largest, 720.0, -720.0, -760.0, 3e6})
    for (const function& f : functions) {
      lanes x = 0.5;
      double all[lanes::count];
      x.store(all);
      all[3] = special;
      const lanes y = f.of_lanes(lanes::load(all));
      const double exact = f.of_one(special);
      if (std::isnan(exact))
        EXPECT_TRUE(std::isnan(y[3])) << f.name << " of " << special;
      else if (std::isinf(exact) || exact == 0.0)
        EXPECT_EQ(y[3], exact) << f.name << " of " << special;
      else
        EXPECT_LE(units(y[3], f.exact(special)), 3.0) << f.name << " of " << special;
      EXPECT_LE(units(y[0], f.exact(0.5L)), 3.0) << f.name;  // the other lanes keep their values
    }
}

}  // namespace lane_functions_test
