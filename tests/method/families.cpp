// Families in closed form: every member is certified, and exactly one name finds it.
#include "tableaux.hpp"

#include <apsis/core/errors.hpp>
#include <apsis/method/coefficient.hpp>
#include <apsis/method/export.hpp>
#include <apsis/method/family_registry.hpp>
#include <apsis/method/intermediate_regime.hpp>
#include <apsis/method/order_conditions.hpp>
#include <apsis/method/trees.hpp>

#include <functional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace apsis::test::families_test {
namespace {

std::string chain(std::size_t s) {
  return "md-imex-chain-" + std::to_string(s) + "-2";
}

std::string plateau_free(std::size_t s) {
  return "md-imex-plateau-free-" + std::to_string(s) + "-2";
}

/// Exact rationals have 60 digits. Only the rounding of sums of up to 64 terms remains.
const mp_real rounding("1e-55");

void expect_member(const std::string& name, std::size_t stages, int evaluations, int r) {
  const method& m = find_method(name);
  const certificate& c = find_certificate(name);
  EXPECT_EQ(m.name, name);
  EXPECT_EQ(m.stages(), stages);
  EXPECT_EQ(m.precision(), 0) << "exact rationals only";
  EXPECT_TRUE(c.claims_hold) << name;
  EXPECT_EQ(c.order, 2) << name;
  EXPECT_LT(c.order_residual, rounding) << name;
  EXPECT_LT(abs(c.ssp_coefficient - r), rounding) << name;
  EXPECT_LT(abs(c.explicit_radius - r), rounding) << name;
  EXPECT_EQ(coefficient_value(m.exact.r), r) << name;
  EXPECT_EQ(c.explicit_evaluations, evaluations) << name;
  EXPECT_EQ(c.implicit_solves, static_cast<int>(stages)) << name;
  EXPECT_TRUE(c.ap) << name;
}

void expect_chain(std::size_t s) {
  expect_member(chain(s), s, static_cast<int>(s) - 1, static_cast<int>(s) - 2);
}

void expect_plateau_free(std::size_t s) {
  expect_member(plateau_free(s), s, static_cast<int>(s) - 2, static_cast<int>(s) - 3);
  const auto terms = analyse_intermediate_regime(find_method(plateau_free(s)).coefficients<mp_real>());
  ASSERT_TRUE(terms.applies) << s;
  for (const auto& one : {terms.flux, terms.last, terms.layer}) EXPECT_LT(abs(one - 1), rounding) << s;
}

TEST(families, have_order_2_and_the_documented_r) {
  for (const std::size_t s : {3U, 4U, 5U, 8U, 16U, 64U}) expect_chain(s);
  for (const std::size_t s : {5U, 6U, 7U, 16U}) expect_plateau_free(s);
}

TEST(SLOW_families, every_member_has_order_2_and_the_documented_r) {
  for (std::size_t s = 3; s <= 64; ++s) expect_chain(s);
  for (std::size_t s = 5; s <= 64; ++s) expect_plateau_free(s);
}

TEST(families, in_a_chain_are_third_order_without_transport) {
  const auto trees = rooted_trees(3, tree_colours::G_only);
  for (const std::size_t s : {3U, 4U, 9U, 16U}) {
    const auto weights = elementary_weights(to_butcher(find_method(chain(s)).coefficients<mp_real>()), trees);
    for (std::size_t k = 0; k < trees.size(); ++k)
      EXPECT_LT(abs(weights[k] - 1 / mp_real(trees[k].density)), rounding) << s << " " << trees[k].name;
  }
}

using exact_form = shu_osher_form<std::string>;

/// Returns the names of the coefficients in which two forms differ, except for ḋ.
std::vector<std::string> differences(const exact_form& a, const exact_form& b) {
  std::vector<std::string> found;
  const auto compare = [&](const std::string& what, const std::string& x, const std::string& y) {
    if (coefficient_value(x) != coefficient_value(y)) found.push_back(what);
  };
  compare("r", a.r, b.r);
  for (std::size_t i = 0; i < a.stages(); ++i)
    for (std::size_t j = 0; j < a.stages(); ++j) {
      compare("P", a.P(i, j), b.P(i, j));
      compare("W", a.W(i, j), b.W(i, j));
      compare("D", a.D(i, j), b.D(i, j));
    }
  return found;
}

TEST(families, in_a_chain_of_three_stages_differ_from_the_papers_method_only_in_ddot) {
  const auto& made = find_method(chain(3)).exact;
  const auto& paper = find_method("md-imex-3-2").exact;
  EXPECT_THAT(differences(made, paper), ::testing::IsEmpty());
  EXPECT_THAT(made.ddot, ::testing::ElementsAre("-1/8", "-1/6", "-1/24"));
  // The error constant is 0.4061 instead of 0.4658 (computed by an independent program).
  EXPECT_NEAR(find_certificate(chain(3)).error_constant.convert_to<double>(), 0.4061164310337068, 1e-15);
  EXPECT_NEAR(find_certificate("md-imex-3-2").error_constant.convert_to<double>(), 0.46584749531245623,
              1e-15);
}

TEST(families, without_plateaus_start_with_the_method_of_the_catalogue) {
  const auto& made = find_method(plateau_free(5)).exact;
  const auto& file = find_method("md-imex-5-2").exact;
  EXPECT_THAT(differences(made, file), ::testing::IsEmpty());
  EXPECT_EQ(made.ddot, file.ddot);
}

TEST(families, without_plateaus_have_nearly_minimal_error_constants) {
  // ḋ_2 + (n−1) ḋ_{n+1} is fixed. Shift t from one to the other and search for an improvement of 3 %.
  for (const std::size_t s : {6U, 10U}) {
    const method& m = find_method(plateau_free(s));
    const auto error = [&](const mp_real& t) {
      method moved = m;
      const auto by = [](std::string& text, const mp_real& change) {
        text = mp_real(coefficient_value(text) + change).str(50, std::ios_base::fixed);
      };
      by(moved.exact.ddot[1], t);
      by(moved.exact.ddot[s - 2], -t / mp_real(s - 3));
      const certificate c = certify(moved);
      EXPECT_EQ(c.order, 2);
      return c.error_constant.convert_to<double>();
    };
    double least = error(0);
    const mp_real half = -coefficient_value(m.exact.ddot[1]);
    for (int k = -9; k <= 9; k += 3) least = std::min(least, error(half * k / 10));
    EXPECT_LT(error(0), 1.03 * least) << s;
  }
}

TEST(families, survive_export_and_parsing) {
  for (const auto& name : {chain(7), plateau_free(7)}) {
    const method& m = find_method(name);
    const method again = parse_method(to_toml(m), "again.toml");
    EXPECT_EQ(to_toml(again), to_toml(m));
    EXPECT_FALSE(again.origin.empty());
    EXPECT_TRUE(certify(again).claims_hold);
  }
}

TEST(families, have_one_name_per_member_and_no_members_out_of_range) {
  for (const std::string s :
       {"2", "65", "x", "S", "07", "+7", "-7", "7.0", "1e1", "3 ", "99999999999999999999"})
    EXPECT_TRUE(is_method_name("md-imex-chain-" + s + "-2"));
  // Names that almost match the pattern are unknown.
  for (const std::string name : {"md-imex-chain-7-3", "md-imex-chain-7", "md-imex-chain-2", "md-imex-chain"})
    EXPECT_FALSE(is_method_name(name)) << name;
}

TEST(families, have_descriptions_with_existing_members) {
  const auto families = family_entries();
  ASSERT_GE(families.size(), 2U);
  for (const family_entry* f : families) {
    EXPECT_FALSE(f->description.empty());
    for (const std::size_t s : {f->lowest, f->highest}) {
      const method& m = find_method(member_name(*f, s));
      const bool of_columns = f->pattern == "extrapolated-euler-S";
      EXPECT_EQ(m.stages(), of_columns ? 2 + s * (s + 1) / 2 : s);
      EXPECT_FALSE(m.title.empty() || m.citation.empty() || m.origin.empty());
      EXPECT_EQ(try_find_family(m.name), f);
    }
  }
}

}  // namespace
}  // namespace apsis::test::families_test
