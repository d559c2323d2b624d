// Claims C1–C8 of the paper. Its tables of order conditions and its Butcher matrices are typed here from the
// page, in its b, c notation, and compared with what the library generates from rooted trees and from the
// Shu–Osher form.
#include "tableaux.hpp"

#include <apsis/method/order_conditions.hpp>

#include <algorithm>
#include <cmath>
#include <map>

#include <gtest/gtest.h>

namespace apsis::test {
namespace {

numbers operator*(const numbers& a, const numbers& b) {
  numbers c(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) c[i] = a[i] * b[i];
  return c;
}

double inner(const numbers& a, const numbers& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

struct abscissae {
  explicit abscissae(const butcher_form<double>& t)
      : A_hat(t.A_hat), A(t.A), A_dot(t.A_dot), e(t.stages(), 1.0) {
    c = A * e;
    c_hat = A_hat * e;
    c_dot = A_dot * e;
    for (std::size_t j = 0; j < e.size(); ++j) {
      b.push_back(A(e.size() - 1, j));
      b_hat.push_back(A_hat(e.size() - 1, j));
      b_dot.push_back(A_dot(e.size() - 1, j));
    }
  }
  matrix<double> A_hat, A, A_dot;
  numbers e, c, c_hat, c_dot, b, b_hat, b_dot;
};

struct printed {
  const char* tree;
  double left, right;
};

/// The table of section 2.1, p ≤ 4, with the tree of each condition in our notation.
std::vector<printed> implicit_table(const abscissae& t) {
  const auto& [Ah, A, Ad, e, c, ch, cd, b, bh, bd] = t;
  return {
      {"G", inner(b, e), 1.0},
      {"G[G]", inner(b, c) + inner(bd, e), 1.0 / 2},
      {"G[G,G]", inner(b, c * c) + 2 * inner(bd, c), 1.0 / 3},
      {"G[G[G]]", inner(b, A * c) + inner(b, cd) + inner(bd, c), 1.0 / 6},
      {"G[G,G,G]", inner(b, c * c * c) + 3 * inner(bd, c * c), 1.0 / 4},
      {"G[G,G[G]]",
       inner(b, c * (A * c)) + inner(b, c * cd) + inner(bd, c * c) + inner(bd, A * c) + inner(bd, cd),
       1.0 / 8},
      {"G[G[G,G]]", inner(b, A * (c * c)) + 2 * inner(b, Ad * c) + inner(bd, c * c), 1.0 / 12},
      {"G[G[G[G]]]",
       inner(b, A * (A * c)) + inner(b, A * cd) + inner(b, Ad * c) + inner(bd, A * c) + inner(bd, cd),
       1.0 / 24},
  };
}

/// The table of section 3.2, p ≤ 3.
std::vector<printed> imex_table(const abscissae& t) {
  const auto& [Ah, A, Ad, e, c, ch, cd, b, bh, bd] = t;
  return {
      {"G", inner(b, e), 1.0},
      {"F", inner(bh, e), 1.0},
      {"G[G]", inner(b, c) + inner(bd, e), 1.0 / 2},
      {"G[F]", inner(b, ch), 1.0 / 2},
      {"F[G]", inner(bh, c), 1.0 / 2},
      {"F[F]", inner(bh, ch), 1.0 / 2},
      {"G[G[G]]", inner(b, A * c) + inner(bd, c) + inner(b, cd), 1.0 / 6},
      {"G[G[F]]", inner(b, A * ch) + inner(bd, ch), 1.0 / 6},
      {"G[F[G]]", inner(b, Ah * c), 1.0 / 6},
      {"G[F[F]]", inner(b, Ah * ch), 1.0 / 6},
      {"F[G[G]]", inner(bh, A * c) + inner(bh, cd), 1.0 / 6},
      {"F[G[F]]", inner(bh, A * ch), 1.0 / 6},
      {"F[F[G]]", inner(bh, Ah * c), 1.0 / 6},
      {"F[F[F]]", inner(bh, Ah * ch), 1.0 / 6},
      {"G[G,G]", inner(b, c * c) + 2 * inner(bd, c), 1.0 / 3},
      {"G[F,G]", inner(b, c * ch) + inner(bd, ch), 1.0 / 3},
      {"G[F,F]", inner(b, ch * ch), 1.0 / 3},
      {"F[G,G]", inner(bh, c * c), 1.0 / 3},
      {"F[F,G]", inner(bh, c * ch), 1.0 / 3},
      {"F[F,F]", inner(bh, ch * ch), 1.0 / 3},
  };
}

void expect_same(const std::vector<printed>& table, const butcher_form<double>& tableau,
                 const std::vector<rooted_tree>& trees) {
  const auto weights = elementary_weights(tableau, trees);
  ASSERT_EQ(table.size(), trees.size());
  for (const auto& row : table) {
    const auto found = std::find_if(trees.begin(), trees.end(),
                                    [&](const rooted_tree& tree) { return tree.name == row.tree; });
    ASSERT_NE(found, trees.end()) << row.tree;
    const auto k = static_cast<std::size_t>(found - trees.begin());
    // Sums of at most some hundred products of numbers below 6: rounding stays below 1e-11 of the largest.
    EXPECT_NEAR(weights[k], row.left, 1e-11 * std::max(1.0, std::abs(row.left))) << row.tree;
    EXPECT_DOUBLE_EQ(1.0 / found->density, row.right) << row.tree;
  }
}

TEST(claims, C1_order_conditions_of_implicit_methods_are_those_printed) {
  const auto trees = rooted_trees(4, tree_colours::G_only);
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const auto tableau = random_tableau(1 + seed % 6, seed);
    expect_same(implicit_table(abscissae(tableau)), tableau, trees);
  }
}

TEST(claims, C2_order_conditions_of_imex_methods_are_those_printed) {
  const auto trees = rooted_trees(3, tree_colours::both);
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const auto tableau = random_tableau(1 + seed % 6, seed);
    expect_same(imex_table(abscissae(tableau)), tableau, trees);
  }
}

/// Entries that the paper prints, by row and column from 1; all others are 0.
using entries = std::map<std::pair<std::size_t, std::size_t>, double>;

void expect_matrix(const matrix<double>& m, const entries& paper, const char* what) {
  for (std::size_t i = 0; i < m.rows(); ++i)
    for (std::size_t j = 0; j < m.cols(); ++j) {
      const auto found = paper.find({i + 1, j + 1});
      // The paper prints 15 decimals, and entries are sums of a few products of such numbers.
      EXPECT_NEAR(m(i, j), found == paper.end() ? 0.0 : found->second, 1e-14) << what << i + 1 << j + 1;
    }
}

TEST(claims, C3_one_stage_second_order_implicit_taylor_method) {
  const auto& c = find_certificate("imdrk-1-2");
  EXPECT_EQ(c.order, 2);
  EXPECT_TRUE(c.unconditional);
  EXPECT_FALSE(c.bounded);
  // R(z) = 1/(1 − z + z²/2) is positive on the negative axis, and |R| ≤ 1 on the whole left half plane.
  EXPECT_GE(c.stability.smallest_on_negative_axis, 0.0);
  EXPECT_DOUBLE_EQ(c.stability.angle, 90.0);
}

TEST(claims, C4_two_stage_third_order_implicit_method_and_its_butcher_form) {
  const auto& c = find_certificate("imdrk-2-3");
  EXPECT_EQ(c.order, 3);
  EXPECT_TRUE(c.unconditional);
  const auto b = to_butcher(find_method("imdrk-2-3").coefficients<double>());
  expect_matrix(b.A_hat, {}, "Ahat");
  expect_matrix(b.A, {{{2, 2}, 1.0}}, "A");
  expect_matrix(b.A_dot, {{{1, 1}, -1.0 / 6}, {{2, 1}, -1.0 / 6}, {{2, 2}, -1.0 / 3}}, "Adot");
}

TEST(claims, C5_five_stage_fourth_order_implicit_method_and_its_butcher_form) {
  const auto& c = find_certificate("imdrk-5-4");
  EXPECT_EQ(c.order, 4);
  EXPECT_TRUE(c.unconditional);
  // The page has the two indices of each entry off the diagonal swapped.
  const double a11 = 0.660949255604937, a41 = 0.060653001401867, a22 = 0.242201390400848,
               a32 = 0.221847558352979, a42 = 0.020022818960029, a33 = 1.137542996287740,
               a43 = 0.102668776898047, a44 = 0.191388711018110, a55 = 0.625266691721946;
  const double d11 = -0.177750705279127, d41 = -0.016311560509453, d22 = -0.354733903778084,
               d32 = -0.324923198367868, d42 = -0.029325895786881, d33 = -0.403963513682271,
               d43 = -0.036459667895230, d44 = -0.161628266349058, d55 = -0.218859021269943;
  const auto table = [](double x11, double x41, double x22, double x32, double x42, double x33, double x43,
                        double x44, double x55) {
    return entries{{{1, 1}, x11}, {{2, 1}, x11}, {{3, 1}, x11}, {{4, 1}, x41}, {{5, 1}, x41},
                   {{2, 2}, x22}, {{3, 2}, x32}, {{4, 2}, x42}, {{5, 2}, x42}, {{3, 3}, x33},
                   {{4, 3}, x43}, {{5, 3}, x43}, {{4, 4}, x44}, {{5, 4}, x44}, {{5, 5}, x55}};
  };
  const auto b = to_butcher(find_method("imdrk-5-4").coefficients<double>());
  expect_matrix(b.A, table(a11, a41, a22, a32, a42, a33, a43, a44, a55), "A");
  expect_matrix(b.A_dot, table(d11, d41, d22, d32, d42, d33, d43, d44, d55), "Adot");
}

TEST(claims, C6_second_order_imex_method_with_r_1_and_its_butcher_form) {
  const auto& c = find_certificate("md-imex-3-2");
  EXPECT_EQ(c.order, 2);
  EXPECT_EQ(c.ssp_coefficient, 1);
  const auto b = to_butcher(find_method("md-imex-3-2").coefficients<double>());
  expect_matrix(b.A_hat, {{{2, 1}, 1.0}, {{3, 1}, 0.5}, {{3, 2}, 0.5}}, "Ahat");
  expect_matrix(b.A, {{{1, 1}, 0.5}, {{2, 1}, 0.5}, {{3, 1}, 0.5}, {{3, 3}, 0.5}}, "A");
  expect_matrix(b.A_dot, {{{2, 2}, -0.5}, {{3, 2}, -0.25}}, "Adot");
}

TEST(claims, C7_third_order_imex_method_and_its_butcher_form) {
  const auto& c = find_certificate("md-imex-6-3");
  EXPECT_EQ(c.order, 3);
  EXPECT_NEAR(c.ssp_coefficient.convert_to<double>(), 0.904402174130635, 1e-15);  // the digits printed
  const auto& m = find_method("md-imex-6-3");
  const auto form = m.coefficients<double>();
  for (std::size_t i = 0; i < m.stages(); ++i) EXPECT_GT(form.D(i, i) + std::abs(form.ddot[i]), 0.0);
  const auto b = to_butcher(form);
  expect_matrix(b.A_hat,
                {{{2, 1}, 0.064631725156397},
                 {{3, 1}, 0.860287477078593},
                 {{4, 1}, 0.259664005325885},
                 {{4, 3}, 0.323441264334256},
                 {{5, 1}, 0.273935075266107},
                 {{5, 3}, 0.090903225623586},
                 {{5, 4}, 0.310757966128278},
                 {{6, 1}, 0.225810414773773},
                 {{6, 3}, 0.175213169672431},
                 {{6, 4}, 0.598976415553796}},
                "Ahat");
  expect_matrix(b.A,
                {{{2, 2}, 2.0},
                 {{3, 2}, 0.471466963417009},
                 {{3, 3}, 0.388820513661584},
                 {{4, 2}, 0.385837646486197},
                 {{4, 3}, 0.113738158737554},
                 {{4, 4}, 0.083529464436389},
                 {{5, 2}, 0.380686852681912},
                 {{5, 3}, 0.031966130008218},
                 {{5, 4}, 0.023475971031425},
                 {{5, 5}, 1.793313488277995},
                 {{6, 2}, 0.299183707820065},
                 {{6, 3}, 0.061613731773316},
                 {{6, 4}, 0.045249211646092},
                 {{6, 5}, 0.593953348760527}},
                "A");
  expect_matrix(b.A_dot,
                {{{1, 1}, -0.871358934880525},
                 {{2, 1}, -0.271731819181020},
                 {{2, 2}, -0.856842702601821},
                 {{3, 1}, -0.730006747169852},
                 {{3, 2}, -0.201986513560852},
                 {{4, 1}, -0.247226665569066},
                 {{4, 2}, -0.165301085890380},
                 {{5, 1}, -0.614323072678900},
                 {{5, 2}, -0.163094375848475},
                 {{5, 5}, -2.0},
                 {{6, 1}, -0.506222742811925},
                 {{6, 2}, -0.128176688391489},
                 {{6, 5}, -0.662408834420649},
                 {{6, 6}, -0.205134529930013}},
                "Adot");
}

TEST(claims, C8_both_imex_methods_are_type_A_and_GSA_with_three_and_six_solves) {
  for (const auto& [name, solves, evaluations] :
       {std::tuple{"md-imex-3-2", 3, 2}, std::tuple{"md-imex-6-3", 6, 3}}) {
    const auto& c = find_certificate(name);
    EXPECT_EQ(c.type, "A") << name;
    EXPECT_TRUE(c.gsa) << name;
    EXPECT_TRUE(c.ap) << name;
    EXPECT_EQ(c.implicit_solves, solves) << name;
    EXPECT_EQ(c.explicit_evaluations, evaluations) << name;
  }
}

}  // namespace
}  // namespace apsis::test
