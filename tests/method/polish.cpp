// Polishing the digits printed in papers gives the digits of the catalogue. The printed coefficients are
// transcribed here. Errors in the files and in polishing thus cannot cancel.
#include <apsis/method/polish.hpp>

#include "tableaux.hpp"

#include <apsis/core/errors.hpp>
#include <apsis/method/coefficient.hpp>

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace apsis::test::polish_test {
namespace {

const std::string printed_imdrk_5_4 = method_text("imdrk-5-4", "implicit", 4, R"([shu_osher]
P = [
  [],
  ["1"],
  ["0.084036809261019", "0.915963190738981"],
  ["0.001511648458457", "0", "0.090254853867587"],
  ["0", "0", "0", "1"],
]
d = ["0.660949255604937", "0.242201390400848", "1.137542996287740", "0.191388711018110", "0.625266691721946"]
ddot = ["-0.177750705279127", "-0.354733903778084", "-0.403963513682271", "-0.161628266349058", "-0.218859021269943"]
)");

// The printed 2 in d and ddot is exact to fifteen decimals, like the other coefficients.
const std::string printed_md_imex_6_3 = method_text("md-imex-6-3", "imex", 3, R"([shu_osher]
r = "0.904402174130635"
P = [
  [],
  ["0.253395246357353"],
  ["0", "0.235733481708505"],
  ["0", "0.123961833526104", "0"],
  ["0.409037644509411", "0.136123556305509", "0", "0"],
  ["0.203353399602184", "0", "0", "0", "0.331204417210324"],
]
W = [
  [],
  ["0.058453072749259"],
  ["0.764266518291495", "0"],
  ["0", "0", "0.292520982667463"],
  ["0.173788618990251", "0", "0", "0.281050180194829"],
  ["0.016811671845949", "0", "0", "0.448630511341543", "0"],
]
d = ["0", "2.000000000000000", "0.388820513661584", "0.083529464436389", "1.793313488277995", "0"]
ddot = ["-0.871358934880525", "-0.856842702601821", "0", "0", "-2.000000000000000", "-0.205134529930013"]
)");

// Method 2.6.1 of Hu, Shu and Zhang in Butcher form. The correction step is the fourth row.
const std::string printed_hsz_a_3_2 = method_text("hsz-a-3-2", "imex", 2, R"([butcher]
A_hat = [
  [],
  ["0.73695027152854"],
  ["0.32152816910844", "0.67847183089156"],
  ["0.32152816910844", "0.67847183089156", "0"],
]
A = [
  ["0.62863517121833"],
  ["0.24310046553707", "0.19593925696632"],
  ["0.48036510509894", "0.074643281386981", "0.44499161351408"],
  ["0.48036510509894", "0.074643281386981", "0.44499161351408", "0"],
]
A_dot = [["0"], ["0", "0"], ["0", "0", "0"], ["0", "0", "0", "-0.27973737915215"]]
)");

/// SSPRK(5,4) of Spiteri and Ruuth is u_i = Σ_j α_ij u_j + Δt β_ij T(u_j). Our form has W = rβ and P = α − rβ
/// with r = min α/β. P = 0 where r is attained to the printed digits.
std::string printed_ssprk_5_4() {
  using rows = std::vector<std::vector<std::string>>;
  const rows alpha = {{"1"},
                      {"0.444370493651235", "0.555629506348765"},
                      {"0.620101851488403", "0", "0.379898148511597"},
                      {"0.178079954393132", "0", "0", "0.821920045606868"},
                      {"0", "0", "0.517231671970585", "0.096059710526147", "0.386708617503269"}};
  const rows beta = {{"0.391752226571890"},
                     {"0", "0.368410593050371"},
                     {"0", "0", "0.251891774271694"},
                     {"0", "0", "0", "0.544974750228521"},
                     {"0", "0", "0", "0.063692468666290", "0.226007483236906"}};
  mp_real r(10);
  for (std::size_t i = 0; i < alpha.size(); ++i)
    for (std::size_t j = 0; j <= i; ++j)
      if (beta[i][j] != "0") r = std::min(r, mp_real(mp_real(alpha[i][j]) / mp_real(beta[i][j])));
  const auto digits = [](const mp_real& x) {
    return abs(x) < mp_real(1e-14) ? std::string("0") : x.str(15, std::ios_base::fixed);
  };
  std::string P = "[[]", W = "[[]";
  for (std::size_t i = 0; i < alpha.size(); ++i) {
    P += ", [";
    W += ", [";
    for (std::size_t j = 0; j <= i; ++j) {
      const mp_real w = r * mp_real(beta[i][j]);
      P += '"' + digits(mp_real(alpha[i][j]) - w) + "\", ";
      W += '"' + digits(w) + "\", ";
    }
    P += "]";
    W += "]";
  }
  return method_text("ssprk-5-4", "explicit", 4,
                     "[shu_osher]\nr = \"" + digits(r) + "\"\nP = " + P + "]\nW = " + W + "]\n");
}

/// Returns pairs of corresponding coefficients of two methods, in file order.
std::vector<std::pair<std::string, std::string>> side_by_side(const method& a, const method& b) {
  std::vector<std::pair<std::string, std::string>> pairs{{a.exact.r, b.exact.r}};
  for (std::size_t i = 0; i < a.stages(); ++i) {
    pairs.emplace_back(a.exact.ddot[i], b.exact.ddot[i]);
    for (std::size_t j = 0; j <= i; ++j) {
      pairs.emplace_back(a.exact.P(i, j), b.exact.P(i, j));
      pairs.emplace_back(a.exact.W(i, j), b.exact.W(i, j));
      pairs.emplace_back(a.exact.D(i, j), b.exact.D(i, j));
    }
  }
  return pairs;
}

mp_real difference(const std::string& a, const std::string& b) {
  return abs(coefficient_value(a) - coefficient_value(b));
}

/// Largest allowed change, and a lower bound of any change, in units of the fifteenth decimal.
struct expected_move {
  std::string name, text;
  double at_most, at_least;
};

class printed_digits : public ::testing::TestWithParam<expected_move> {};

TEST_P(printed_digits, lead_to_the_digits_of_the_catalogue) {
  const method printed = parse_method(GetParam().text, "printed.toml");
  const auto result = polish(printed);
  EXPECT_LT(result.residual, mp_real("1e-45"));
  for (const auto& [polished, known] : side_by_side(result.polished, find_method(GetParam().name)))
    EXPECT_LT(difference(polished, known), mp_real("1e-40")) << polished << " and " << known;
}

TEST_P(printed_digits, satisfy_the_order_conditions_after_export_with_45_decimals) {
  const auto c = certify(polish(parse_method(GetParam().text, "printed.toml")).polished);
  EXPECT_TRUE(c.claims_hold);
  // Each of some forty decimals is rounded by up to 5e-46, with weights in the conditions of order 10.
  EXPECT_LT(c.order_residual, mp_real("1e-43"));
}

TEST_P(printed_digits, move_by_almost_the_minimum) {
  const auto& [name, text, at_most, at_least] = GetParam();
  const method printed = parse_method(text, "printed.toml");
  const auto result = polish(printed);
  const mp_real unit("1e-15");
  mp_real largest(0);
  for (const auto& [polished, before] : side_by_side(result.polished, printed)) {
    const mp_real moved = difference(polished, before);
    largest = std::max(largest, moved);
    EXPECT_LE(moved, mp_real(at_most) * unit) << before << " became " << polished;
    if (decimals(before) == 0) {
      EXPECT_EQ(polished, before) << "an exact coefficient has changed";
    }
  }
  // The reported change refers to the unrounded coefficients.
  EXPECT_LT(abs(largest - result.largest_move), mp_real("1e-44"));
  // The dual bound is below the change found, and close to it. The polished method is thus almost optimal.
  EXPECT_GE(result.smallest_possible_move, mp_real(at_least) * unit);
  // The bound holds for linearized conditions. Changes of 1e-15 change gradients by about the
  // same relative amount.
  EXPECT_LE(result.smallest_possible_move, result.largest_move * mp_real(1 + 1e-12));
}

// For the third-order IMEX method no coefficients within one unit of all printed digits satisfy the
// conditions exactly: the bound is 1.07. For SSPRK(5,4), r = min α/β is accurate only to about 1e-14. Hu, Shu
// and Zhang print fourteen digits, so a unit of their last digit is 10 here.
INSTANTIATE_TEST_SUITE_P(papers, printed_digits,
                         ::testing::Values(expected_move{"imdrk-5-4", printed_imdrk_5_4, 0.72, 0.70},
                                           expected_move{"md-imex-6-3", printed_md_imex_6_3, 1.08, 1.07},
                                           expected_move{"hsz-a-3-2", printed_hsz_a_3_2, 4.6, 4.4},
                                           expected_move{"ssprk-5-4", printed_ssprk_5_4(), 8.1, 1.0}),
                         [](const auto& each) {
                           std::string name = each.param.name;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

// A maximum that ignores NaN would report convergence here.
TEST(polish, does_not_accept_nan_as_a_solution) {
  const method& m = find_method("md-imex-6-3");
  const auto broken = [](const shu_osher_form<mp_real>&) {
    return std::vector<mp_real>{std::numeric_limits<mp_real>::quiet_NaN()};
  };
  EXPECT_THROW(polish(m, 45, broken), numerical_error);
}

}  // namespace
}  // namespace apsis::test::polish_test
