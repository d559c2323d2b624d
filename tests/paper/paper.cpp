// Every claim of the registry, as `apsis reproduce` checks it. `make test-all` includes the slow ones.
#include <apsis/core/errors.hpp>
#include <apsis/exec/parallel.hpp>

#include <cmath>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <paper/claim_registry.hpp>
#include <paper/condition_tables.hpp>
#include <paper/paper_tables.hpp>
#include <paper/reproduce.hpp>

namespace apsis::paper_test {
namespace {

using namespace apsis::paper;

std::vector<std::string> ids(bool slow) {
  std::vector<std::string> chosen;
  for (const auto* entry : claim_entries())
    if (entry->slow == slow) chosen.push_back(entry->id);
  return chosen;
}

void expect_to_hold(const std::string& id) {
  const auto checked = check_claim(*find_claims({id}).at(0), {});
  EXPECT_EQ(checked["error"], "");
  for (const auto& finding : checked["findings"])
    EXPECT_TRUE(finding["holds"].get<bool>()) << finding.dump(2);
  EXPECT_TRUE(checked["holds"].get<bool>());
  for (const auto& picture : checked["pictures"])
    for (const auto& panel : picture["panels"]) {
      EXPECT_FALSE(panel["x_label"].get<std::string>().empty()) << picture["name"];
      EXPECT_FALSE(panel["y_label"].get<std::string>().empty()) << picture["name"];
      EXPECT_FALSE(picture["caption"].get<std::string>().empty()) << picture["name"];
      EXPECT_FALSE(panel["curves"].empty() && panel["maps"].empty()) << picture["name"];
    }
}

class claims : public testing::TestWithParam<std::string> {};
TEST_P(claims, holds) {
  expect_to_hold(GetParam());
}
INSTANTIATE_TEST_SUITE_P(paper, claims, testing::ValuesIn(ids(false)), [](const auto& p) { return p.param; });

class SLOW_claims : public testing::TestWithParam<std::string> {};
TEST_P(SLOW_claims, holds) {
  set_threads(0);
  expect_to_hold(GetParam());
  set_threads(1);
}
INSTANTIATE_TEST_SUITE_P(paper, SLOW_claims, testing::ValuesIn(ids(true)),
                         [](const auto& p) { return p.param; });
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(SLOW_claims);

TEST(paper_tables, a_wrong_term_is_detected) {
  const auto wrong = [](const butcher_form<double>& t) {
    auto rows = printed_imex_conditions(t);
    rows[6].left += 1e-6;
    return rows;
  };
  EXPECT_GT(compare_with_print(rooted_trees(3, tree_colours::both), wrong).first, 1e-9);
  const auto missing = [](const butcher_form<double>& t) {
    auto rows = printed_imex_conditions(t);
    rows[6].tree = "G[F,F,F]";
    return rows;
  };
  EXPECT_TRUE(std::isnan(compare_with_print(rooted_trees(3, tree_colours::both), missing).first));
}

TEST(paper_tables, the_prints_of_different_methods_differ) {
  EXPECT_LE(distance_to_print("md-imex-6-3"), 1e-14);
  try {
    printed_butcher_form("imdrk-1-2");
    FAIL() << "a print was found";
  } catch (const input_error& refused) {
    EXPECT_STREQ(refused.what(), "the paper prints no Butcher form of 'imdrk-1-2'");
  }
  for (const auto& [row, column, value] : printed_butcher_form("md-imex-6-3").A)
    EXPECT_TRUE(column <= row && value > 0.0) << row << column;
}

TEST(reproduction, a_check_that_throws_is_a_claim_that_does_not_hold) {
  const claim_entry bad = {"C0", "none", "false", "by hand", [](const study_control&) -> claim_result {
                             throw input_error("no such case (why) do");
                           }};
  const auto checked = check_claim(bad, {});
  EXPECT_FALSE(checked["holds"].get<bool>());
  EXPECT_EQ(checked["error"], "no such case (why) do");
}

}  // namespace
}  // namespace apsis::paper_test
