// A method given by its Butcher form is the method given by its Shu–Osher form.
#include "tableaux.hpp"

#include <apsis/core/errors.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace apsis::test {
namespace {

std::string head(const std::string& kind, int order, const std::string& claim) {
  return "name = \"x\"\ntitle = \"\"\ncitation = \"\"\nkind = \"" + kind +
         "\"\n[claims]\norder = " + std::to_string(order) + "\nssp_coefficient = \"" + claim +
         "\"\n[butcher]\n";
}

void expect_same_form(const method& a, const method& b) {
  const auto x = a.coefficients<double>(), y = b.coefficients<double>();
  ASSERT_EQ(x.stages(), y.stages());
  // Both are correctly rounded from numbers that agree to 47 digits, or lie on the same grid.
  EXPECT_DOUBLE_EQ(x.r, y.r);
  for (std::size_t i = 0; i < x.stages(); ++i) {
    EXPECT_DOUBLE_EQ(x.ddot[i], y.ddot[i]);
    for (std::size_t j = 0; j <= i; ++j) {
      EXPECT_DOUBLE_EQ(x.W(i, j), y.W(i, j)) << i << j;
      EXPECT_DOUBLE_EQ(x.D(i, j), y.D(i, j)) << i << j;
    }
  }
}

TEST(butcher_files, give_the_second_order_imex_method_its_shu_osher_form) {
  const method m = parse_method(head("imex", 2, "1") +
                                    "A_hat = [[], [\"1\"], [\"1/2\", \"1/2\"]]\n"
                                    "A = [[\"1/2\"], [\"1/2\", \"0\"], [\"1/2\", \"0\", \"1/2\"]]\n"
                                    "A_dot = [[\"0\"], [\"0\", \"-1/2\"], [\"0\", \"-1/4\", \"0\"]]\n",
                                "x");
  EXPECT_TRUE(certify(m).claims_hold);
  expect_same_form(m, find_method("md-imex-3-2"));
}

TEST(butcher_files, give_the_third_order_implicit_method_its_shu_osher_form) {
  const method m =
      parse_method(head("implicit", 3, "unconditional") +
                       "A = [[\"0\"], [\"0\", \"1\"]]\nA_dot = [[\"-1/6\"], [\"-1/6\", \"-1/3\"]]\n",
                   "x");
  EXPECT_TRUE(certify(m).claims_hold);
  expect_same_form(m, find_method("imdrk-2-3"));
}

TEST(butcher_files, give_explicit_methods_their_canonical_form) {
  const method m = parse_method(
      head("explicit", 3, "1") + "A_hat = [[], [\"1\"], [\"1/4\", \"1/4\"], [\"1/6\", \"1/6\", \"2/3\"]]\n",
      "x");
  const auto c = certify(m);
  EXPECT_TRUE(c.claims_hold) << ::testing::PrintToString(c.failures);
  for (std::size_t i = 0; i < m.stages(); ++i)
    for (std::size_t j = 0; j < i; ++j) EXPECT_EQ(m.exact.P(i, j), "0");
}

TEST(butcher_files, without_a_convex_form_are_refused_with_the_entry_that_forbids_it) {
  // Q(u_1) enters stage 2 explicitly, with a weight that no convex combination of u^n and u_1 gives.
  try {
    parse_method(head("imex", 1, "0") + "A_hat = [[], [\"1\"]]\nA = [[\"1\"], [\"2\", \"1\"]]\n", "x");
    FAIL();
  } catch (const input_error& refused) {
    EXPECT_THAT(refused.what(), ::testing::StartsWith("x:10:5: "));
    EXPECT_THAT(refused.what(), ::testing::HasSubstr("no convex Shu-Osher form"));
  }
}

}  // namespace
}  // namespace apsis::test
