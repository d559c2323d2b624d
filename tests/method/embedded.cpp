// Embedded rows of method files: parsing, export and certificate.
#include "support/catalogue.hpp"
#include "tableaux.hpp"

#include <apsis/core/errors.hpp>
#include <apsis/method/coefficient.hpp>
#include <apsis/method/export.hpp>
#include <apsis/method/order_conditions.hpp>

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace apsis::test::embedded_test {
namespace {

using ::testing::HasSubstr;

// The file is md-imex-3-2 with u + Δt T(u_1)/2 + … of order 1. Lines: 16 [embedded], 17 order, 18 P, 19 W, 20
// d, 21 ddot.
const std::string good = R"(name = "x"
title = "t"
citation = "c"
kind = "imex"

[claims]
order = 2
ssp_coefficient = "1"

[shu_osher]
r = "1"
P = [[], ["0"], ["1/2", "0"]]
W = [[], ["1"], ["0", "1/2"]]
d = ["1/2", "0", "1/2"]
ddot = ["0", "-1/2", "0"]
[embedded]
order = 1
P = ["9/20", "0", "0"]
W = ["1/10", "9/20", "0"]
d = "1/2"
ddot = "-3/40"
)";

std::string changed(const std::string& old, const std::string& replacement) {
  std::string text = good;
  const auto at = text.rfind(old);
  EXPECT_NE(at, std::string::npos) << old;
  return text.replace(at, old.size(), replacement);
}

std::vector<std::string> failures(const std::string& text) {
  return certify(parse_method(text, "m.toml")).failures;
}

TEST(embedded_row, is_certified_with_its_estimate) {
  const auto c = certify(parse_method(good, "m.toml"));
  EXPECT_TRUE(c.claims_hold);
  ASSERT_TRUE(c.embedded);
  EXPECT_EQ(c.embedded->order, 1);
  EXPECT_EQ(c.embedded->conditions, 2);
  EXPECT_EQ(c.embedded->implicit_solves, 1);
  EXPECT_EQ(c.embedded->explicit_evaluations, 0);
  EXPECT_TRUE(c.embedded->relaxes);
  // By hand: u_1 has c = (1/2), ĉ = 0; u_2 = u_1 + Δt T(u_1) − Δt² Q̇/2 has ĉ = 1. The embedded solution is ũ
  // = 0.45 u_1 + 0.1 (u_1 + Δt T(u_1)) + 0.45 (u_2 + Δt T(u_2)) + …. The four conditions of order 2 have 1/γ
  // = 1/2 and the left-hand sides
  //   T[T] = 0.45 · 1 = 0.45,   T[Q] = 0.55 · ½ + 0.45 · ½ = ½,   Q[T] = d̃ = ½,
  //   Q[Q] = ¼ (of u_1) − 0.45 · ½ (of Q̇ in u_2) + d̃ − 3/40 = 0.45.
  EXPECT_NEAR(c.embedded->estimate.convert_to<double>(), 0.05 * std::sqrt(2.0), 1e-15);
  EXPECT_NEAR(c.embedded->alignment.convert_to<double>(), std::sqrt(0.5), 1e-15);
}

// The weight is the error constant over the estimate along the Taylor term. Both are factors of Δt^p.
TEST(embedded_row, has_a_weight_where_its_estimate_is_far_below_the_error_constant) {
  for (const std::string name : {"md-imex-16-4-efficient", "md-imex-8-3-large-r", "md-imex-5-2"}) {
    const certificate& c = find_certificate(name);
    const mp_real along = c.embedded->estimate * c.embedded->alignment;
    EXPECT_GT(c.embedded->weight, 2.0) << name;
    EXPECT_NEAR(c.embedded->weight * 18 * along.convert_to<double>(), c.error_constant.convert_to<double>(),
                1e-13)
        << name;
    EXPECT_EQ(find_method(name).embedded->weight, c.embedded->weight) << name;
  }
  EXPECT_EQ(find_certificate("md-imex-8-3-accurate").embedded->weight, 1.0);  // the ratio is 12
  EXPECT_EQ(find_certificate("md-imex-16-4-large-r").embedded->weight, 1.0);  // q = p − 2
  EXPECT_EQ(find_certificate("extrapolated-euler-8").embedded->weight, 1.0);  // no error constant
  // The estimate has no part along the Taylor term.
  EXPECT_LT(find_certificate("extrapolated-euler-6").embedded->alignment, 1e-50);
  EXPECT_EQ(find_certificate("extrapolated-euler-6").embedded->weight, 1.0);
}

TEST(embedded_row, does_not_change_the_certificate_of_the_method) {
  for (const auto& name : methods_where([](const method& m) { return m.embedded.has_value(); })) {
    method m = find_method(name);
    const auto with = find_certificate(name);
    m.embedded.reset();
    const auto without = certify(m);
    EXPECT_EQ(with.order, without.order) << name;
    EXPECT_EQ(with.ssp_coefficient, without.ssp_coefficient) << name;
    EXPECT_EQ(with.type, without.type) << name;
    EXPECT_EQ(with.implicit_solves, without.implicit_solves) << name;
    EXPECT_FALSE(without.embedded) << name;
  }
}

TEST(embedded_row, exists_for_every_recommended_method_at_the_cost_of_one_solve) {
  const auto names = methods_where([](const method& m) {
    return !m.purpose.empty() || m.name == "md-imex-3-2" || m.name == "md-imex-6-3";
  });
  EXPECT_GE(names.size(), 16U);
  for (const auto& name : names) {
    const auto& e = find_certificate(name).embedded;
    ASSERT_TRUE(e) << name;
    EXPECT_LT(e->order, find_certificate(name).order) << name;
    EXPECT_EQ(e->implicit_solves, 1) << name;
    EXPECT_EQ(e->explicit_evaluations, 0) << name;
    EXPECT_LT(e->order_residual, mp_real(1e-42)) << name;  // sums of a dozen terms with 45 digits
    if (find_certificate(name).keeps_slow_terms) {
      ASSERT_TRUE(e->last) << name;
      EXPECT_LT(abs(*e->last - 1), mp_real(1e-40)) << name;
    }
    // The search required at least 1/30 of the Taylor term, with a coverage of at least 0.15 in the limit ε →
    // 0. The terms of the limit are 0.4 of all.
    EXPECT_GT(e->estimate, mp_real(0.15 * 0.4 / 30)) << name;
    EXPECT_LT(e->estimate, mp_real(0.15)) << name;
  }
}

TEST(embedded_row, is_shown_in_latex) {
  const std::string shown = to_latex(find_method("md-imex-3-2"));
  EXPECT_THAT(shown, testing::HasSubstr("\\frac{9}{20} & 0 & 0 \\\\"));
  EXPECT_THAT(shown, testing::HasSubstr("\\tilde w &="));
  EXPECT_THAT(shown, testing::HasSubstr("\\frac{1}{10} & \\frac{9}{20} & 0"));
  EXPECT_THAT(shown, testing::HasSubstr("\\tilde d &= \\frac{1}{2}"));
  EXPECT_THAT(shown, testing::HasSubstr("\\tilde{\\dot d} &= -\\frac{3}{40}"));
  EXPECT_THAT(to_latex(find_method("imdrk-2-3")), testing::Not(testing::HasSubstr("tilde")));
}

TEST(embedded_row, is_exported_as_it_was_read) {
  auto names = methods_where([](const method& m) { return m.embedded.has_value(); });
  for (const auto& name : names) {
    const method& m = find_method(name);
    const method again = parse_method(to_toml(m), name);
    ASSERT_TRUE(again.embedded) << name;
    EXPECT_EQ(again.embedded->order, m.embedded->order);
    EXPECT_EQ(again.embedded->convex, m.embedded->convex);
    EXPECT_EQ(again.embedded->origin, m.embedded->origin);
    EXPECT_EQ(again.embedded->P, m.embedded->P);
    EXPECT_EQ(again.embedded->W, m.embedded->W);
    EXPECT_EQ(again.embedded->d, m.embedded->d);
    EXPECT_EQ(again.embedded->ddot, m.embedded->ddot);
  }
  // Omitted entries are zero. The solution has order 1 and two stages of forward Euler steps.
  const std::string explicit_method =
      "name = \"x\"\ntitle = \"t\"\ncitation = \"c\"\nkind = \"explicit\"\n[claims]\norder = 2\n"
      "[shu_osher]\nr = \"1\"\nP = [[], [\"0\"], [\"1/2\", \"0\"]]\nW = [[], [\"1\"], [\"0\", \"1/2\"]]\n"
      "[embedded]\norder = 1\nP = [\"0\", \"1\", \"0\"]\n";
  const auto c = certify(parse_method(explicit_method, "m.toml"));
  EXPECT_THAT(c.failures, ::testing::IsEmpty());
  EXPECT_EQ(c.embedded->implicit_solves, 0);
  EXPECT_FALSE(c.embedded->relaxes);
}

TEST(embedded_row, of_a_tableau_is_given_by_its_weights) {
  // Heun's method of order 3 has the radius of monotonicity 0.
  const std::string heun =
      "name = \"x\"\ntitle = \"t\"\ncitation = \"c\"\nkind = \"explicit\"\n[claims]\norder = 3\n"
      "[butcher]\nA_hat = [[], [\"1/3\"], [\"0\", \"2/3\"]]\nb_hat = [\"1/4\", \"0\", "
      "\"3/4\"]\n[embedded]\norder = 2\n";
  const method m = parse_method(heun + "b_hat = [\"0\", \"1/2\", \"1/2\"]\n", "m.toml");
  const auto c = certify(m);
  EXPECT_THAT(c.failures, ::testing::IsEmpty());
  EXPECT_EQ(c.embedded->order, 2);
  EXPECT_EQ(c.embedded->explicit_evaluations, 0);
  EXPECT_EQ(m.embedded->W, (std::vector<std::string>{"0", "1/2", "1/2", "0"}));
  EXPECT_EQ(m.embedded->P, (std::vector<std::string>{"0", "-1/2", "-1/2", "0"}));
  EXPECT_THAT(failures(heun + "b_hat = [\"1/2\", \"1/2\"]\n"), ::testing::Not(::testing::IsEmpty()));
}

TEST(embedded_row, of_wrong_order_or_sign_fails_certification) {
  using ::testing::Contains, ::testing::ElementsAre;
  // As embedded solution u^{n+1} itself has order 2, not 1 as the file claims.
  EXPECT_THAT(failures(changed(good.substr(good.find("P = [\"9/20\"")),
                               "P = [\"1/2\", \"0\", \"0\"]\nW = [\"0\", \"1/2\", \"0\"]\nd = \"1/2\"\n")),
              ElementsAre("embedded.order = 1 but the embedded solution has order 2"));
  EXPECT_THAT(failures(changed("order = 1", "order = 2")),
              Contains("embedded.order = 2 is not below the order 2 of the method, so that the error could "
                       "not be estimated"));
  EXPECT_THAT(failures(changed("ddot = \"-3/40\"", "ddot = \"3/40\"")),
              ElementsAre(HasSubstr("embedded.ddot = -0.075 is negative")));
  EXPECT_THAT(failures(changed("[\"9/20\", \"0\", \"0\"]", "[\"19/20\", \"-1/2\", \"0\"]")),
              Contains(HasSubstr("embedded.P_2 = -0.5 is negative")));
  EXPECT_THAT(failures(changed("[\"1/10\", \"9/20\"", "[\"1/5\", \"9/20\"")),
              Contains(HasSubstr("the weight of u^n in [embedded] = -0.1 is negative")));
}

TEST(embedded_row, that_is_not_convex_is_certified_if_the_file_says_so) {
  // u_1 equals u^n up to the implicit part and replaces it. The conditions of order 1 hold for any weights of
  // u_1 and u_2 with Σ_j p̃_j c_j + w̃_j … = 1.
  const std::string negative =
      "P = [\"-1/20\", \"1/2\", \"0\"]\nW = [\"1/10\", \"9/20\", \"0\"]\nd = \"1/2\"\nddot = \"-3/40\"\n";
  const auto with = [&](const std::string& key) {
    return failures(changed(good.substr(good.find("P = [\"9/20\"")), key + negative));
  };
  EXPECT_THAT(with(""), ::testing::Contains(HasSubstr("embedded.P_1 = -0.05 is negative")));
  for (const auto& failure : with("convex = false\n")) EXPECT_THAT(failure, Not(HasSubstr("is negative")));
}

TEST(embedded_row, of_order_p_minus_1_exists_for_all_but_two_imex_methods) {
  for (const auto& name : methods_where([](const method& m) { return m.embedded.has_value(); })) {
    const method& m = find_method(name);
    if (m.kind != method_kind::imex) continue;
    const bool lower = name == "md-imex-6-3" || name == "md-imex-16-4-large-r";
    EXPECT_EQ(m.embedded->order < m.claims.order - 1, lower) << name;
  }
}

/// A change of a coefficient by 1e-6 violates a condition. Conditions of order 1 do not involve Q̇, so two
/// coefficients are exempt: d̃̇, and the weight of a first stage with ḋ alone, for which u_1 = u^n + O(Δt²).
void expect_changes_are_detected(const method& m) {
  method damaged = m;
  const auto expect_noticed = [&](std::string& place, const std::string& what) {
    const std::string kept = place;
    if (coefficient_value(kept) == 0) return;
    place = mp_real(coefficient_value(kept) + mp_real(1e-6)).str(45, std::ios_base::fixed);
    EXPECT_FALSE(certify(damaged).claims_hold) << m.name << " " << what;
    place = kept;
  };
  auto& e = *damaged.embedded;
  for (std::size_t j = 0; j < m.stages(); ++j) {
    // In a tableau u_1 = u^n. Its weight is the rest of the other weights.
    if (e.order > 1 && (e.convex || j > 0)) expect_noticed(e.P[j], "P" + std::to_string(j + 1));
    expect_noticed(e.W[j], "W" + std::to_string(j + 1));
  }
  expect_noticed(e.d, "d");
  if (e.order > 1) expect_noticed(e.ddot, "ddot");
}

TEST(embedded_row, with_a_changed_coefficient_is_detected) {
  for (const auto& name : methods_where([](const method& m) { return m.embedded && m.stages() < 9; }))
    expect_changes_are_detected(find_method(name));
}

TEST(SLOW_embedded_row, with_a_changed_coefficient_is_detected_for_many_stages) {
  for (const auto& name : methods_where([](const method& m) { return m.embedded && m.stages() >= 9; }))
    expect_changes_are_detected(find_method(name));
}

TEST(embedded_row, shares_the_evaluation_of_the_order_conditions_with_the_method) {
  for (const char* name : {"md-imex-8-3-accurate", "ark-548-2", "extrapolated-euler-5"}) {
    const method& m = find_method(name);
    const auto alone = to_butcher(m.coefficients<mp_real>());
    const auto extended = to_butcher(m.with_embedded_row().coefficients<mp_real>());
    order_levels<mp_real> levels(extended, colours_of(m.kind), 2);
    std::size_t before = 0;
    for (int order = 1; order <= 5; ++order) {
      const auto trees = rooted_trees(order, colours_of(m.kind));
      const auto& level = levels.at(order);
      ASSERT_EQ(before + level.trees.size(), trees.size()) << name;
      const auto weights = elementary_weights(alone, trees), of_row = elementary_weights(extended, trees);
      for (std::size_t k = 0; k < level.trees.size(); ++k) {
        EXPECT_EQ(level.trees[k].name, trees[before + k].name);
        EXPECT_EQ(level.weights[0][k], weights[before + k])
            << name << " " << level.trees[k].name;  // every bit
        EXPECT_EQ(level.weights[1][k], of_row[before + k]) << name << " " << level.trees[k].name;
      }
      before = trees.size();
    }
  }
}

TEST(certificate_of_claims, has_everything_that_a_method_claims_and_its_steps_use) {
  for (const char* name :
       {"md-imex-8-3-accurate", "ark-548-2", "dop853", "imdrk-9-5", "extrapolated-euler-4"}) {
    const method& m = find_method(name);
    const certificate all = certify(m), claims = certify(m, certificate_scope::claims);
    EXPECT_EQ(claims.order, all.order) << name;
    EXPECT_EQ(claims.order_residual, all.order_residual) << name;
    EXPECT_EQ(claims.ssp_coefficient, all.ssp_coefficient) << name;
    EXPECT_EQ(claims.type, all.type) << name;
    EXPECT_EQ(claims.remaining_terms(), all.remaining_terms()) << name;
    EXPECT_EQ(claims.failures, all.failures) << name;
    ASSERT_EQ(claims.embedded.has_value(), all.embedded.has_value()) << name;
    if (all.embedded) {
      EXPECT_EQ(m.embedded->weight, all.embedded->weight) << name;
    }
    EXPECT_EQ(find_certificate(name).stability.angle, all.stability.angle) << name;  // complete
  }
  EXPECT_EQ(find_certificate("extrapolated-euler-2").stability.angle, 90.0);
}

TEST(certificate_of_claims, includes_the_stability_that_a_file_claims) {
  const auto holds = [](bool claimed) {
    method m = find_method("extrapolated-euler-2");  // L-stable
    m.claims.l_stable = claimed;
    return certify(m, certificate_scope::claims).claims_hold;
  };
  EXPECT_TRUE(holds(true));
  EXPECT_FALSE(holds(false));
}

}  // namespace
}  // namespace apsis::test::embedded_test
