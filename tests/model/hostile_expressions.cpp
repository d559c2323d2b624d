// Adversarial formulas have a value, or one short message with its place. None crashes.
#include <apsis/model/expression.hpp>

#include <cmath>
#include <random>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <support/bad_input.hpp>

namespace hostile_expressions_test {

using apsis::expression;
using testing::HasSubstr;
using testing::StartsWith;

namespace {

std::string repeated(const std::string& part, int times) {
  std::string out;
  for (int k = 0; k < times; ++k) out += part;
  return out;
}

/// Returns the message, or "" if the formula has a value at 0.5 (possibly NaN).
std::string message_of(const std::string& text) {
  try {
    const expression f(text, {"c.toml", 3, 12});
    static_cast<void>(f.value(0.5));
    return "";
  } catch (const apsis::input_error& e) {
    return e.what();
  }
}

std::string value_message(const std::string& text, double x) {
  try {
    static_cast<void>(expression(text, {"c.toml", 3, 12}).evaluate(x));
    return "";
  } catch (const apsis::input_error& e) {
    return e.what();
  }
}

}  // namespace

TEST(hostile_expression, of_any_depth_and_length_has_a_value_or_one_short_message) {
  const std::string texts[] = {repeated("(", 499) + "x" + repeated(")", 499),
                               repeated("(", 1000),
                               repeated("-", 999) + "x",
                               repeated("sin(", 150) + "x" + repeated(")", 150),
                               repeated("x^", 499) + "x",
                               repeated("x?", 300),
                               repeated("x?1:", 249) + "x",
                               repeated("1,", 500),
                               repeated("x", 1000),
                               repeated("min(x,", 160) + "x" + repeated(")", 160),
                               repeated("+", 1000),
                               repeated("9", 1000),
                               "1e999999999",
                               "x" + repeated("*x", 499),
                               std::string(1'000'000, '('),
                               std::string(1'000'000, 'x')};
  for (const auto& text : texts) {
    const std::string message = message_of(text);
    if (message.empty()) continue;
    EXPECT_THAT(message, StartsWith("c.toml:3:")) << text.substr(0, 40);
    EXPECT_LT(message.size(), 400U) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    EXPECT_THAT(message, HasSubstr("); ")) << message;
  }
  bad_input::expect_refused({{[] { expression(std::string(1'000'000, '('), {"c.toml", 3, 12}); },
                              {"1000000 characters (at most 1000 are read)"}}});
  EXPECT_EQ(message_of(repeated("(", 499) + "x" + repeated(")", 499)), "");
}

TEST(hostile_expression, shows_the_wrong_part_of_a_long_formula) {
  const std::string message = message_of(repeated("x+", 200) + "foo" + repeated("+x", 200));
  EXPECT_THAT(message, StartsWith("c.toml:3:412: "));
  EXPECT_EQ(message.find("did you mean"), std::string::npos);
}

TEST(hostile_expression, invalid_values_are_reported_with_their_point) {
  EXPECT_THAT(value_message("1/(x - 0.25)", 0.25), StartsWith("c.toml:3:12: "));
  EXPECT_LT(value_message("0/x" + repeated("+x", 400), 0.0).size(), 250U);
}

TEST(hostile_expression, random_tokens_never_end_the_program) {
  const std::string tokens[] = {"x", "1",  "e", "pi", "+",  "-",  "*",  "/",  "^",    "(",
                                ")", ",",  "?", ":",  "<",  ">=", "==", "!=", "sin(", "min(",
                                ".", "e5", " ", "&&", "||", "!",  "_",  "0x", "1e"};
  std::mt19937 random(7);
  int good = 0;
  for (int k = 0; k < 20'000; ++k) {
    std::string text;
    for (auto n = 1 + random() % 9; n > 0; --n) text += tokens[random() % std::size(tokens)];
    const std::string message = message_of(text);
    if (message.empty())
      ++good;
    else
      EXPECT_THAT(message, StartsWith("c.toml:3:")) << text;
  }
  // Some random texts must be formulas, otherwise the test is vacuous.
  EXPECT_GT(good, 100);
}

}  // namespace hostile_expressions_test
