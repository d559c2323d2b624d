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

namespace formula_table_test {

using namespace apsis;
using testing::HasSubstr;
using testing::StartsWith;

namespace {

std::string message_of(const std::string& text) {
  try {
    const expression formula(text, {"c.toml", 3, 12});
    return "";
  } catch (const input_error& e) {
    return e.what();
  }
}

}  // namespace

TEST(formula_table, interpolates_and_is_constant_beyond_its_points) {
  const expression f("2*table(x - 1, 0, 1, 0.5, 2, +2.5, -6) + 1");
  // The interpolation of binary fractions is exact.
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
  // More characters than a formula without tables may have.
  for (int k = 0; k < 5000; ++k) points.emplace_back(k / 3.0, std::sin(k));
  const expression f(formula_of_table("x", points));
  std::vector<std::thread> threads;
  for (int of = 0; of < 4; ++of)
    threads.emplace_back([&] {
      for (const auto& [x, v] : points) EXPECT_EQ(f.value(x), v);
    });
  for (auto& one : threads) one.join();
}

TEST(formula_table, that_cannot_be_read_has_one_message_with_its_place) {
  const std::vector<std::pair<std::string, std::string>> wrong = {
      {"1 + table",
       "c.toml:3:16: expression '1 + table' cannot be used (a table without points at character 5); "
       "write for example table(t, 0, 1, 0.5, 2)"},
      {"table(x)", "a table without points at character 1"},
      {"table(x, 0, 1, 2)", "the last point of a table has no value at character 17"},
      {"table(x, 0, 1, 0, 2)", "arguments of a table do not increase at character 16); sort its points"},
      {"table(x, 0, 1, y, 2)", "a point of a table is not a finite number at character 16"},
      {"table(x, 0, 1, 1e999, 2)", "a point of a table is not a finite number at character 16"},
      {"table(x, 0, 1 2, 2)", "a table does not end here at character 15"},
      {"table(x, 0, 1", "a table does not end here"},
      {"table(x,", "a point of a table is not a finite number"},
      {"table(foo, 0, 1)", "unknown name 'foo' at character 7"},
      {"table(x, 0, 1) + foo", "unknown name 'foo' at character 18"}};
  for (const auto& [text, says] : wrong) {
    EXPECT_THAT(message_of(text), HasSubstr(says)) << text;
    EXPECT_THAT(message_of(text), StartsWith("c.toml:3:")) << text;
  }
  std::string nested = "x";
  for (int k = 0; k < 101; ++k) nested = "table(" + nested + ",0,1)";
  EXPECT_THAT(message_of(nested), HasSubstr("more than 100 tables"));
  EXPECT_EQ(why_not_a_constant("table"), "formulas have a function or constant of this name");
}

}  // namespace formula_table_test
