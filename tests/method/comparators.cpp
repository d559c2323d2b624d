// Methods from the literature: the method files agree with the published coefficients.
#include "tableaux.hpp"

#include <algorithm>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace apsis::test::comparators_test {
namespace {

/// Expects the printed entries by row and column, counted from 1. All others must be 0.
using entries = std::map<std::pair<std::size_t, std::size_t>, double>;

void expect_matrix(const matrix<double>& m, const entries& printed, double tolerance, const char* what) {
  for (std::size_t i = 0; i < m.rows(); ++i)
    for (std::size_t j = 0; j < m.cols(); ++j) {
      const auto found = printed.find({i + 1, j + 1});
      EXPECT_NEAR(m(i, j), found == printed.end() ? 0.0 : found->second, tolerance) << what << i + 1 << j + 1;
    }
}

TEST(comparators, method_2_6_2_of_hu_shu_zhang_has_the_published_butcher_form) {
  // The last row is u^{n+1} after the correction with α = 0.8. The correction does not change T and Q.
  const auto b = to_butcher(find_method("hsz-ars-4-2").coefficients<double>());
  constexpr double rounding = 1e-15;  // for a dozen operations on numbers below 2
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
  // By hand, the weight 1 − 0.3/1.6 of u^n in the third stage carries an Euler step of length 1, so it is r.
  const auto& c = find_certificate("hsz-ars-4-2");
  EXPECT_NEAR(c.ssp_coefficient.convert_to<double>(), 1 - 0.3 / 1.6, 1e-15);
  EXPECT_EQ(c.type, "ARS");
  EXPECT_FALSE(c.ap);
}

/// Returns SSP3(4,3,3) with any α, β = α/4 and η = (1 − 2α)/4.
std::string member_of_ssp3_433(const mp_real& alpha) {
  const auto text = [](const mp_real& x) { return '"' + x.str(50, std::ios_base::fixed) + '"'; };
  const std::string a = text(alpha);
  return "name = \"x\"\ntitle = \"\"\ncitation = \"\"\nkind = \"imex\"\n[claims]\norder = 3\n[butcher]\n"
         "A_hat = [[], [\"0\"], [\"0\", \"1\"], [\"0\", \"1/4\", \"1/4\"]]\n"
         "b_hat = [\"0\", \"1/6\", \"1/6\", \"2/3\"]\nA = [[" +
         a + "], [" + text(-alpha) + ", " + a + "], [\"0\", " + text(1 - alpha) + ", " + a + "], [" +
         text(alpha / 4) + ", " + text((1 - 2 * alpha) / 4) + ", " + text((1 - 3 * alpha) / 4) + ", " + a +
         "]]\nb = [\"0\", \"1/6\", \"1/6\", \"2/3\"]\n";
}

TEST(comparators, ssp3_433_is_the_l_stable_member_of_a_family_of_order_3) {
  for (const double alpha : {0.2, 0.2416, 0.3, 0.45}) {
    const auto c = certify(parse_method(member_of_ssp3_433(mp_real(alpha)), "x"));
    EXPECT_TRUE(c.claims_hold) << alpha;
    EXPECT_FALSE(c.stability.l_stable) << alpha;
  }
  // R(−∞) = 0 means (2α − 1)(3α² − 9α + 2) = 0. The other root below 1 is 1/2.
  const mp_real root = (9 - sqrt(mp_real(57))) / 6;
  EXPECT_TRUE(certify(parse_method(member_of_ssp3_433(root), "x")).stability.l_stable);
  const auto b = to_butcher(find_method("ssp3-433").coefficients<mp_real>());
  EXPECT_LT(abs(b.A(0, 0) - root), mp_real("1e-49"));
  // The printed digits of the root, β and η are rounded values.
  EXPECT_LT(abs(b.A(0, 0) - mp_real("0.24169426078821")), mp_real("0.5e-14"));
  EXPECT_LT(abs(b.A(3, 0) - mp_real("0.06042356519705")), mp_real("0.5e-14"));
  EXPECT_LT(abs(b.A(3, 1) - mp_real("0.12915286960590")), mp_real("0.5e-14"));
}

TEST(comparators, bhr_553_follows_from_gamma_and_c4) {
  const auto b = to_butcher(find_method("bhr-553").coefficients<mp_real>());
  const mp_real gamma = b.A(1, 1), c3 = 2 * gamma, c4 = mp_real(3) / 2;
  const mp_real digits("1e-48");
  EXPECT_LT(abs(((gamma - 3) * gamma + mp_real(3) / 2) * gamma - mp_real(1) / 6), digits);
  const auto row_sum = [&](const matrix<mp_real>& a, std::size_t i) {
    mp_real sum(0);
    for (std::size_t j = 0; j < b.stages(); ++j) sum += a(i, j);
    return sum;
  };
  const std::vector<mp_real> c = {0, c3, c3, c4, 1, 1};
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_LT(abs(row_sum(b.A, i) - c[i]), digits) << i;
    EXPECT_LT(abs(row_sum(b.A_hat, i) - c[i]), digits) << i;
    EXPECT_LT(abs(b.A(5, i) - b.A_hat(5, i)), digits) << i;  // b̂ = b
    EXPECT_LT(abs(b.A(5, i) - b.A(4, i)), digits) << i;      // the implicit part is stiffly accurate
    if (i < 2) continue;
    // From the third stage on the stage order is 2: A c = c²/2, and the same for Â.
    mp_real implicit(0), transport(0);
    for (std::size_t j = 0; j < 6; ++j) {
      implicit += b.A(i, j) * c[j];
      transport += b.A_hat(i, j) * c[j];
    }
    EXPECT_LT(abs(implicit - c[i] * c[i] / 2), digits) << i;
    EXPECT_LT(abs(transport - c[i] * c[i] / 2), digits) << i;
  }
  // The last coefficient follows from b·Âc² = 1/12, a condition of order 4.
  mp_real fourth(0);
  for (std::size_t i = 0; i < 5; ++i)
    for (std::size_t j = 0; j < i; ++j) fourth += b.A_hat(5, i) * b.A_hat(i, j) * c[j] * c[j];
  EXPECT_LT(abs(fourth - mp_real(1) / 12), digits);
  // The printed digits are rounded correctly, except for the last one in two cases.
  const mp_real half_unit("0.5e-15");
  EXPECT_LT(abs(b.A(4, 2) - mp_real("0.362863385578740")), half_unit);
  EXPECT_LT(abs(b.A(4, 3) + mp_real("0.168124349878957")), half_unit);
  EXPECT_LT(abs(b.A_hat(4, 2) - mp_real("1.195970114894582")), half_unit);
  EXPECT_LT(abs(b.A_hat(4, 3) + mp_real("0.150831109536247")), half_unit);  // printed …248
  EXPECT_LT(abs(gamma - mp_real("0.435866521508459")), half_unit);          // printed …460
}

/// The rational coefficients in common use belong to the older BHR(5,5,3) with c_4 = 2684624/1147171
/// (Boscarino, Appl. Numer. Math. 59 (2009)).
TEST(comparators, rational_coefficients_of_bhr_satisfy_their_conditions_to_13_digits_only) {
  const std::string g = "424782/974569", zero = "0";
  const std::string b1 = "487698502336740678603511/1181159636928185920260208",
                    b3 = "302987763081184622639300143137943089/1535359944203293318639180129368156500",
                    b4 = "-105235928335100616072938218863/2282554452064661756575727198000";
  const auto row = [](const std::vector<std::string>& values) {
    std::string text = "[";
    for (const auto& value : values) text += '"' + value + "\", ";
    return text + "]";
  };
  const std::string text =
      "name = \"x\"\ntitle = \"\"\ncitation = \"\"\nkind = \"imex\"\n[claims]\norder = 3\n[butcher]\nA_hat = "
      "[[], " +
      row({"849564/974569"}) + ", " + row({g, g}) + ", " +
      row({"-475883375220285986033264/594112726933437845704163", zero,
           "1866233449822026827708736/594112726933437845704163"}) +
      ", " +
      row({"62828845818073169585635881686091391737610308247/176112910684412105319781630311686343715753056000",
           "-" + b3, "262315887293043739337088563996093207/297427554730376353252081786906492000",
           "-987618231894176581438124717087/23877337660202969319526901856000"}) +
      "]\nb_hat = " + row({b1, zero, b3, b4, g}) + "\nA = [" + row({zero}) + ", " + row({g, g}) + ", " +
      row({g, "-31733082319927313/455705377221960889379854647102", g}) + ", " +
      row({"-3012378541084922027361996761794919360516301377809610/"
           "45123394056585269977907753045030512597955897345819349",
           "-62865589297807153294268/102559673441610672305587327019095047",
           "418769796920855299603146267001414900945214277000/"
           "212454360385257708555954598099874818603217167139",
           g}) +
      ", " + row({b1, zero, b3, b4, g}) + "]\nb = " + row({b1, zero, b3, b4, g}) + "\n";
  const auto c = certify(parse_method(text, "x"));
  EXPECT_FALSE(c.claims_hold);
  EXPECT_EQ(c.order, 1);  // the rationals are exact, and their b·c is not 1/2
  mp_real largest(0);
  for (const auto& condition : c.next)
    largest = std::max(largest, mp_real(abs(condition.value - condition.wanted)));
  EXPECT_GT(largest, mp_real("1e-15"));
  EXPECT_LT(largest, mp_real("1e-13"));
}

}  // namespace
}  // namespace apsis::test::comparators_test
