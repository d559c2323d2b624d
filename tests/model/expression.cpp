#include <apsis/model/expression.hpp>

#include <apsis/model/formula_table.hpp>

#include <array>
#include <atomic>
#include <cmath>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>
#include <support/bad_input.hpp>

namespace expression_test {

using apsis::expression;
using apsis::input_error;
using testing::HasSubstr;

TEST(expression, agrees_with_the_formula_of_the_mixed_regime) {
  const expression epsilon("1e-5 + tanh(1 - 11*(x - 1)) + tanh(1 + 11*(x - 1))");
  EXPECT_FALSE(epsilon.is_constant());
  // The sum is also a quotient without a common operation: tanh a + tanh b = sinh(a + b)/(cosh a cosh b).
  for (double x = 0.0; x <= 2.0; x += 0.01) {
    const double y = 11.0 * (x - 1.0);
    const double exact = 1e-5 + std::sinh(2.0) / (std::cosh(1.0 - y) * std::cosh(1.0 + y));
    // Both terms are at most 1, with a few rounding errors of 1.1e-16 each.
    EXPECT_NEAR(epsilon.evaluate(x), exact, 1e-15);
  }
}

TEST(expression, has_the_usual_precedence_and_constants) {
  EXPECT_DOUBLE_EQ(expression("2 + 3 * 2^2").evaluate(0), 14.0);
  EXPECT_DOUBLE_EQ(expression("10 - 2 - 3").evaluate(0), 5.0);
  EXPECT_DOUBLE_EQ(expression("4 - -x").evaluate(3), 7.0);
  EXPECT_DOUBLE_EQ(expression("log(e) + sin(pi/2) + log10(100)").evaluate(0), 4.0);
  EXPECT_DOUBLE_EQ(expression("x < 1 ? 2 : 3").evaluate(0.5), 2.0);
  EXPECT_DOUBLE_EQ(expression("x == 1 ? 2 : 3").evaluate(1.0), 2.0);
  EXPECT_DOUBLE_EQ(expression("max(min(x, 2), 1)").evaluate(5.0), 2.0);
  EXPECT_TRUE(expression("1e-3").is_constant());
}

RC_GTEST_PROP(expression, reads_back_every_nonnegative_number, (double x)) {
  RC_PRE(std::isfinite(x) && x >= 0.0);
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", x);
  RC_ASSERT(expression(text).evaluate(0.0) == x);
}

RC_GTEST_PROP(expression, random_text_is_a_formula_or_an_input_error, ()) {
  const auto text = *rc::gen::container<std::string>(
      rc::gen::elementOf(std::string("x0123.+-*/^()<>=?:!&|, esinxpabqrt\"\n")));
  try {
    expression(text).evaluate(0.3);
  } catch (const input_error& e) {
    RC_ASSERT(std::string(e.what()).size() > 10);
  }
}

TEST(expression, accepts_another_variable_and_negative_values_on_request) {
  const apsis::formula_kind flux{{"u"}, false};
  const expression f("u^2/2 - 1", {"file", 3, 10}, flux);
  EXPECT_DOUBLE_EQ(f.evaluate(1.0), -0.5);
  EXPECT_FALSE(f.is_constant());
  // value() never throws, but evaluate() does.
  const expression root("sqrt(u)", {"file", 3, 10}, flux);
  EXPECT_TRUE(std::isnan(root.value(-1.0)));
  EXPECT_THROW(root.evaluate(-1.0), input_error);
  bad_input::expect_refused(
      {{[&] { expression("u + x", {"file", 3, 10}, flux); }, {"file:3:14: ", "unknown name 'x'"}}});
}

TEST(expression, uses_the_coordinates_of_its_space) {
  const expression plane("x + 10*y", {"file", 3, 10}, apsis::formula_of_position(2));
  const std::array<double, 3> at = {0.25, 0.5, 7.0};
  EXPECT_DOUBLE_EQ(plane.evaluate(at), 5.25);
  const expression space("x*y*z", {}, apsis::formula_of_position(3));
  EXPECT_DOUBLE_EQ(space.value(at), 0.875);
  EXPECT_FALSE(space.is_constant());
  bad_input::expect_refused({{[&] { expression("x + z", {"file", 3, 10}, apsis::formula_of_position(2)); },
                              {"file:3:14: ", "unknown name 'z'"}}});
  bad_input::expect_refused(
      {{[&] { static_cast<void>(expression("y - 1", {}, apsis::formula_of_position(2)).evaluate(at)); },
        {"is -0.5 at x = 0.25, y = 0.5"}}});
}

TEST(expression, has_constants_of_the_user) {
  const expression f("M*x + gas_2", {}, {{"x"}, true, {{"M", 2.0}, {"gas_2", 0.5}}});
  EXPECT_EQ(f.value(3.0), 6.5);
  EXPECT_FALSE(f.is_constant());
  EXPECT_TRUE(expression("M^2", {}, {{"x"}, true, {{"M", 2.0}}}).is_constant());
  bad_input::expect_refused({{[&] { expression("Mach*x", {"file", 3, 12}, {{"x"}, true, {{"Mac", 2.0}}}); },
                              {"did you mean 'Mac'?"}}});
  EXPECT_EQ(apsis::why_not_a_constant("Kn_0"), "");
  for (const char* name : {"", "1st", "a-b", "_a", "a b", "x", "t", "v_x", "pi", "e", "sin", "max"})
    EXPECT_NE(apsis::why_not_a_constant(name), "") << name;
}

TEST(expression, rounds_every_operation_as_it_is_written) {
  // Sums and products have the order of the text, not (10/3) x or 4 x/2 · ….
  const std::vector<double> x = {0.1, 0.7, 1.3, 2.9, 1e-3, 7e5};
  const auto expect = [&](const std::string& text, const auto& value) {
    const expression of(text, {}, {{"u"}, false, {{"g", 0.3}}});
    for (const double u : x) EXPECT_EQ(of.value(u), value(u)) << text << " at " << u;
  };
  expect("10*u/3", [](double u) { return 10.0 * u / 3.0; });
  expect("g*u*7 - u + g", [](double u) { return 0.3 * u * 7.0 - u + 0.3; });
  expect("-u^2 + u^3/u - u^4", [](double u) { return -(u * u) + u * u * u / u - u * u * u * u; });
  expect("(u + g)^2", [](double u) { return (u + 0.3) * (u + 0.3); });
  expect("2^u^2", [](double u) { return std::pow(2.0, u * u); });
  expect("u^1.5 - 2 - -u", [](double u) { return std::pow(u, 1.5) - 2.0 - -u; });
  expect("(u <= 0.7) + (u > 1)*(u != g)",
         [](double u) { return (u <= 0.7 ? 1.0 : 0.0) + (u > 1.0 ? 1.0 : 0.0); });
  expect("max(u, g)*sin(2*u)", [](double u) { return std::fmax(u, 0.3) * std::sin(2.0 * u); });
  const apsis::formula_table table({{0.0, 1.0}, {1.0, 3.0}});
  expect("2*table(u, 0, 1, 1, 3) - u", [&](double u) { return 2.0 * table.at(u) - u; });
  expect("+g", [](double) { return 0.3; });
}

TEST(expression, has_the_same_values_at_many_points_as_at_each) {
  const apsis::formula_kind kind{{"a", "b", "c"}, false, {{"g", 1.4}}};
  // Formulas with and without a condition, at more points than are evaluated together.
  for (const char* text :
       {"c", "7", "a/b*(c + (g - 1)*(c - a^2/(2*b)))", "a > b ? c : -a", "exp(a)*b^0.3 - c",
        "(a < b) || (c < 1)", "((a + b)*(a - c) - (b + c)*(b - a))/((a + 1)*(b + 2) + c^4)"}) {
    const expression of(text, {}, kind);
    for (const std::size_t points : {1u, 3u, 8u, 64u, 65u, 150u}) {
      std::vector<double> rows, columns(3 * points), of_rows(points), of_columns(points);
      for (std::size_t k = 0; k < 3 * points; ++k)
        rows.push_back(0.1 + 0.37 * static_cast<double>((k * k) % 23));
      for (std::size_t k = 0; k < 3 * points; ++k) columns[k % 3 * points + k / 3] = rows[k];
      of.values(rows, of_rows);
      of.values_of_columns(columns, of_columns);
      EXPECT_EQ(of_rows, of_columns) << text;
      for (std::size_t p = 0; p < points; ++p)
        EXPECT_EQ(of_rows[p], of.value(std::span<const double>(rows).subspan(3 * p, 3)))
            << text << " of " << points;
    }
  }
}

TEST(expression, evaluates_formulas_with_many_intermediate_results) {
  // In a pyramid of parentheses each level has an open sum. These exceed the available columns.
  std::string text = "x", end;
  double exact = 1.0;
  for (int level = 0; level < 60; ++level) {
    text = "x + 1/(" + text;
    end += ")";
  }
  for (int level = 0; level < 60; ++level) exact = 1.0 + 1.0 / exact;
  EXPECT_EQ(expression(text + end).value(1.0), exact);
  std::string left, right;
  for (int level = 0; level < 40; ++level) {
    left += "(x + 1)*(";
    right += ")";
  }
  EXPECT_EQ(expression(left + "x" + right).value(1.0), std::pow(2.0, 40.0));
}

TEST(expression, is_evaluated_by_many_threads_concurrently) {
  const expression f("sin(u)/2 + u^3 - (u > 0.5 ? exp(-u) : 2*u)", {}, {{"u"}, false});
  const auto exact = [](double u) { return std::sin(u) / 2 + u * u * u - (u > 0.5 ? std::exp(-u) : 2 * u); };
  // More threads than the expression has parsers evaluate the same formula.
  std::atomic<int> wrong{0};
  std::vector<std::thread> threads;
  for (int t = 0; t < 80; ++t)
    threads.emplace_back([&, t] {
      for (int k = 0; k < 2000; ++k) {
        const double u = 1e-4 * k + 1e-3 * t;
        if (std::abs(f.value(u) - exact(u)) > 1e-15) ++wrong;
      }
    });
  for (auto& thread : threads) thread.join();
  EXPECT_EQ(wrong, 0);
}

}  // namespace expression_test
