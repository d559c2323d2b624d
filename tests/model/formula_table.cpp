// Tables in formulas: values, digits, messages, length.
#include <apsis/model/formula_table.hpp>

#include <apsis/model/expression.hpp>

#include <cmath>
#include <limits>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <support/bad_input.hpp>

namespace formula_table_test {

using namespace apsis;

TEST(formula_table, interpolates_and_is_constant_beyond_its_points) {
  const expression f("2*table(x - 1, 0, 1, 0.5, 2, +2.5, -6) + 1");
  // Interpolation of binary fractions is exact.
  const std::vector<std::pair<double, double>> values = {{-9, 3}, {1, 3},  {1.25, 4}, {1.5, 5},
                                                         {2, 1},  {3, -7}, {99, -11}};
  for (const auto& [x, wanted] : values) EXPECT_EQ(f.value(x), wanted) << x;
  EXPECT_TRUE(std::isnan(expression("table(log(x), 0, 1, 1, 2)").value(-1.0)));
  EXPECT_FALSE(f.is_constant());
  EXPECT_TRUE(expression("table(0.5, 0, 1, 1, 2)").is_constant());
  EXPECT_EQ(expression("table(table(x, 0, 0, 1, 10), 0, 3, 10, 5)").value(0.5), 4.0);
}

TEST(formula_table, of_all_digits_has_the_values_of_its_points) {
  std::vector<std::pair<double, double>> points;
  // The formula has more characters than one without tables may have.
  for (int k = 0; k < 5000; ++k) points.emplace_back(k / 3.0, std::sin(k));
  const expression f(formula_of_table("x", points));
  std::vector<std::thread> threads;
  for (int of = 0; of < 4; ++of)
    threads.emplace_back([&] {
      for (const auto& [x, v] : points) EXPECT_EQ(f.value(x), v);
    });
  for (auto& one : threads) one.join();
}

TEST(formula_table, of_two_arguments_is_linear_in_each) {
  // The values at the corners of [0, 1]² are those of 1 + 2x + 4y + 8xy. Interpolation of binary
  // fractions is exact.
  const formula_kind plane{.variables = {"x", "y"}, .nonnegative = false};
  const expression f("1 + table2(x, y + 1, 2, 0, 1, 1, 0, 2, 2, 4, 14)", {}, plane);
  for (const double x : {0.0, 0.25, 0.5, 1.0})
    for (const double y : {0.0, 0.125, 0.75, 1.0})
      EXPECT_EQ(f.value(std::vector{x, y}), 1 + 2 * x + 4 * y + 8 * x * y) << x << " " << y;
  EXPECT_EQ(f.value(std::vector{-3.0, 7.0}), 5.0);
  EXPECT_EQ(f.value(std::vector{9.0, -7.0}), 3.0);
  EXPECT_TRUE(std::isnan(f.value(std::vector{0.0, std::nan("")})));
  EXPECT_EQ(expression("table2(x, 5, 3, 0, 1, 2, 0, 7, 8, 9)").value(1.5), 8.5);
  // Tables of both kinds are nested.
  const expression nested(
      "table2(table(x, 0, 0, 1, 10), table2(x, x, 1, 0, 0, 1), 2, 0, 10, 0, 0, 0, 2, 4, 8)");
  EXPECT_EQ(nested.value(0.5), 3.0);
}

TEST(formula_table, of_two_arguments_and_all_digits_has_the_values_of_its_points) {
  const std::vector<double> a = {-1.0 / 3.0, 0.1, 0.7}, b = {0.3, 2.0 / 7.0 + 1.0};
  const std::vector<double> values = {std::sin(1), std::sin(2), std::sin(3),
                                      std::sin(4), std::sin(5), std::sin(6)};
  const expression f(formula_of_table("x", "y", a, b, values), {}, {.variables = {"x", "y"}});
  for (std::size_t j = 0; j < b.size(); ++j)
    for (std::size_t i = 0; i < a.size(); ++i) EXPECT_EQ(f.value(std::vector{a[i], b[j]}), values[3 * j + i]);
}

TEST(formula_table, is_refused_within_a_hundred_others) {
  std::string nested = "x";
  for (int k = 0; k < 101; ++k) nested = "table(" + nested + ",0,1)";
  bad_input::expect_refused(
      {{[&] { expression(nested, {"c.toml", 3, 12}); }, {"c.toml:3:", "more than 100 tables"}}});
  for (const char* name : {"table", "table2"})
    EXPECT_EQ(why_not_a_constant(name), "formulas have a function or constant of this name");
}

}  // namespace formula_table_test
