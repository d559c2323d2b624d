// Methods of others: what their authors print, typed here from the page, against what the files say.
#include "tableaux.hpp"

#include <map>

#include <gtest/gtest.h>

namespace apsis::test {
namespace {

/// Entries that are printed, by row and column from 1; all others are 0.
using entries = std::map<std::pair<std::size_t, std::size_t>, double>;

void expect_matrix(const matrix<double>& m, const entries& printed, double tolerance, const char* what) {
  for (std::size_t i = 0; i < m.rows(); ++i)
    for (std::size_t j = 0; j < m.cols(); ++j) {
      const auto found = printed.find({i + 1, j + 1});
      EXPECT_NEAR(m(i, j), found == printed.end() ? 0.0 : found->second, tolerance) << what << i + 1 << j + 1;
    }
}

TEST(comparators, method_2_6_2_of_hu_shu_zhang_has_their_butcher_form) {
  // The last row is u^{n+1} after the correction with α = 0.8, which leaves T and Q as they are.
  const auto b = to_butcher(find_method("hsz-ars-4-2").coefficients<double>());
  constexpr double rounding = 1e-15;  // of a dozen operations with numbers below 2
  expect_matrix(b.A_hat, {{{3, 1}, 1.0}, {{4, 1}, 0.5}, {{4, 3}, 0.5}, {{5, 1}, 0.5}, {{5, 3}, 0.5}},
                rounding, "Ahat");
  expect_matrix(b.A,
                {{{2, 2}, 1.6},
                 {{3, 2}, 0.3},
                 {{3, 3}, 0.7},
                 {{4, 2}, 0.5},
                 {{4, 3}, 0.3},
                 {{4, 4}, 0.2},
                 {{5, 2}, 0.5},
                 {{5, 3}, 0.3},
                 {{5, 4}, 0.2}},
                rounding, "A");
  expect_matrix(b.A_dot, {{{5, 5}, -0.8}}, rounding, "Adot");
  // r by hand: the weight of u^n in the third stage, 1 − 0.3/1.6, carries an Euler step of length 1.
  const auto& c = find_certificate("hsz-ars-4-2");
  EXPECT_NEAR(c.ssp_coefficient.convert_to<double>(), 1 - 0.3 / 1.6, 1e-15);
  EXPECT_EQ(c.type, "ARS");
  EXPECT_FALSE(c.ap);
}

}  // namespace
}  // namespace apsis::test
