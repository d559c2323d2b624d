// Method files in Butcher form define the same methods as files in Shu–Osher form.
#include "tableaux.hpp"

#include <apsis/core/errors.hpp>

#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace apsis::test::butcher_files_test {
namespace {

std::string head(const std::string& kind, int order, const std::string& claim) {
  return "name = \"x\"\ntitle = \"\"\ncitation = \"\"\nkind = \"" + kind +
         "\"\n[claims]\norder = " + std::to_string(order) + "\nssp_coefficient = \"" + claim +
         "\"\n[butcher]\n";
}

void expect_same_form(const method& a, const method& b) {
  const auto x = a.coefficients<double>(), y = b.coefficients<double>();
  ASSERT_EQ(x.stages(), y.stages());
  // Both numbers are correctly rounded from values that agree to 47 digits, or rounded to the same grid.
  EXPECT_DOUBLE_EQ(x.r, y.r);
  for (std::size_t i = 0; i < x.stages(); ++i) {
    EXPECT_DOUBLE_EQ(x.ddot[i], y.ddot[i]);
    for (std::size_t j = 0; j <= i; ++j) {
      EXPECT_DOUBLE_EQ(x.W(i, j), y.W(i, j)) << i << j;
      EXPECT_DOUBLE_EQ(x.D(i, j), y.D(i, j)) << i << j;
    }
  }
}

TEST(butcher_files, reproduce_the_shu_osher_form_of_the_second_order_imex_method) {
  const method m = parse_method(head("imex", 2, "1") +
                                    "A_hat = [[], [\"1\"], [\"1/2\", \"1/2\"]]\n"
                                    "A = [[\"1/2\"], [\"1/2\", \"0\"], [\"1/2\", \"0\", \"1/2\"]]\n"
                                    "A_dot = [[\"0\"], [\"0\", \"-1/2\"], [\"0\", \"-1/4\", \"0\"]]\n",
                                "x");
  EXPECT_TRUE(certify(m).claims_hold);
  expect_same_form(m, find_method("md-imex-3-2"));
}

TEST(butcher_files, reproduce_the_shu_osher_form_of_the_third_order_implicit_method) {
  const method m =
      parse_method(head("implicit", 3, "unconditional") +
                       "A = [[\"0\"], [\"0\", \"1\"]]\nA_dot = [[\"-1/6\"], [\"-1/6\", \"-1/3\"]]\n",
                   "x");
  EXPECT_TRUE(certify(m).claims_hold);
  expect_same_form(m, find_method("imdrk-2-3"));
}

TEST(butcher_files, reproduce_the_canonical_form_of_explicit_methods) {
  const method m = parse_method(
      head("explicit", 3, "1") + "A_hat = [[], [\"1\"], [\"1/4\", \"1/4\"], [\"1/6\", \"1/6\", \"2/3\"]]\n",
      "x");
  const auto c = certify(m);
  EXPECT_TRUE(c.claims_hold) << ::testing::PrintToString(c.failures);
  for (std::size_t i = 0; i < m.stages(); ++i)
    for (std::size_t j = 0; j < i; ++j) EXPECT_EQ(m.exact.P(i, j), "0");
}

TEST(butcher_files, reproduce_the_exact_weights_of_hu_shu_zhang) {
  // The first stage is u^n, so it has the weight of u^n in every row.
  const method m = parse_method(
      head("imex", 2, "0.8125") +
          "A_hat = [[], [\"0\"], [\"1\", \"0\"], [\"1/2\", \"0\", \"1/2\"], [\"1/2\", \"0\", \"1/2\", "
          "\"0\"]]\n"
          "A = [[\"0\"], [\"0\", \"1.6\"], [\"0\", \"0.3\", \"0.7\"], [\"0\", \"0.5\", \"0.3\", \"0.2\"], "
          "[\"0\", \"0.5\", \"0.3\", \"0.2\", \"0\"]]\n"
          "A_dot = [[\"0\"], [\"0\", \"0\"], [\"0\", \"0\", \"0\"], [\"0\", \"0\", \"0\", \"0\"], "
          "[\"0\", \"0\", \"0\", \"0\", \"-0.8\"]]\n",
      "x");
  const auto c = certify(m);
  EXPECT_TRUE(c.claims_hold) << ::testing::PrintToString(c.failures);
  expect_same_form(m, find_method("hsz-ars-4-2"));
}

const std::string midpoint_rows = "A_hat = [[], [\"1/2\"]]\nA = [[\"0\"], [\"0\", \"1/2\"]]\n";
const std::string midpoint_update = "b_hat = [\"0\", \"1\"]\nb = [\"0\", \"1\"]\n";

TEST(butcher_files, treat_an_update_as_an_additional_row) {
  // The method is the IMEX midpoint rule, ARS(1,2,2).
  const method m = parse_method(head("imex", 2, "0") + midpoint_rows + midpoint_update, "x");
  EXPECT_TRUE(m.ends_with_update());
  EXPECT_EQ(m.stages(), 3u);
  const auto c = certify(m);
  EXPECT_TRUE(c.claims_hold) << ::testing::PrintToString(c.failures);
  EXPECT_FALSE(c.gsa);
  EXPECT_EQ(c.type, "ARS");
  EXPECT_EQ(c.ap_data, "consistent data (moments only)");
  EXPECT_EQ(c.implicit_solves, 1);
  EXPECT_EQ(c.explicit_evaluations, 2);
  const auto b = to_butcher(m.coefficients<double>());
  EXPECT_EQ(b.A_hat(2, 1), 1.0);
  EXPECT_EQ(b.A(2, 1), 1.0);
  EXPECT_EQ(b.A(2, 2), 0.0);
}

TEST(butcher_files, support_updates_for_methods_of_every_kind) {
  // In the implicit midpoint rule Q(u_1) has a larger weight in u^{n+1} than u_1 provides.
  const method implicit = parse_method(head("implicit", 2, "0") + "A = [[\"1/2\"]]\nb = [\"1\"]\n", "x");
  EXPECT_TRUE(certify(implicit).claims_hold);
  EXPECT_FALSE(certify(implicit).gsa);
  // The classical Runge–Kutta method is explicit and has no convex form.
  const method kutta = parse_method(head("explicit", 4, "0") +
                                        "A_hat = [[], [\"1/2\"], [\"0\", \"1/2\"], [\"0\", \"0\", \"1\"]]\n"
                                        "b_hat = [\"1/6\", \"1/3\", \"1/3\", \"1/6\"]\n",
                                    "x");
  EXPECT_TRUE(certify(kutta).claims_hold) << ::testing::PrintToString(certify(kutta).failures);
  // The update of Heun's method is a convex combination with r = 1.
  const method heun =
      parse_method(head("explicit", 2, "1") + "A_hat = [[], [\"1\"]]\nb_hat = [\"1/2\", \"1/2\"]\n", "x");
  EXPECT_TRUE(certify(heun).claims_hold);
}

TEST(butcher_files, with_any_byte_changed_do_not_crash) {
  const std::string good = head("imex", 2, "0") + midpoint_rows + "A_dot = [[\"0\"], [\"0\", \"0\"]]\n" +
                           midpoint_update + "b_dot = [\"0\", \"0\"]\n";
  std::mt19937 draw(3);
  int read = 0;
  for (int k = 0; k < 2000; ++k) {
    std::string text = good;
    // The mutations are in the coefficients, where most changes leave a valid file.
    const std::size_t start = good.find("A_hat");
    text[start + draw() % (text.size() - start)] = "0123456789/-.e\", ]"[draw() % 19];
    try {
      certify(parse_method(text, "x"));
      ++read;
    } catch (const input_error&) {
      // Exceptions of other types fail the test.
    }
  }
  EXPECT_GT(read, 100);  // some mutants are valid
}

}  // namespace
}  // namespace apsis::test::butcher_files_test
