// Findings, and the registry of claims.
#include <apsis/core/errors.hpp>

#include <cmath>
#include <set>

#include <gtest/gtest.h>
#include <paper/claim_registry.hpp>

namespace claims_test {

using namespace apsis;
using namespace apsis::paper;

TEST(findings, hold_only_within_their_bounds) {
  EXPECT_TRUE(at_most("x", 1.0, 1.0).holds);
  EXPECT_FALSE(at_most("x", std::nextafter(1.0, 2.0), 1.0).holds);
  EXPECT_TRUE(at_least("x", 1.0, 1.0).holds);
  EXPECT_FALSE(at_least("x", std::nextafter(1.0, 0.0), 1.0).holds);
  EXPECT_TRUE(close_to("x", 2.9, 3.0, 0.15).holds);
  EXPECT_FALSE(close_to("x", 2.8, 3.0, 0.15).holds);
  EXPECT_FALSE(exactly("x", 2, 3).holds);
}

TEST(findings, never_hold_for_nan) {
  const double nan = std::nan("");
  EXPECT_FALSE(at_most("x", nan, 1.0).holds);
  EXPECT_FALSE(at_least("x", nan, 1.0).holds);
  EXPECT_FALSE(close_to("x", nan, 1.0, 1.0).holds);
}

TEST(findings, a_claim_without_a_finding_does_not_hold) {
  claim_result result;
  EXPECT_FALSE(result.all_hold());
  result.findings.push_back(is_true("x", true));
  EXPECT_TRUE(result.all_hold());
  result.findings.push_back(is_true("y", false));
  EXPECT_FALSE(result.all_hold());
}

TEST(claim_registry, has_different_ids_and_complete_entries) {
  std::set<std::string> ids;
  for (const auto* entry : claim_entries()) {
    EXPECT_TRUE(ids.insert(entry->id).second) << entry->id;
    EXPECT_FALSE(entry->statement.empty() || entry->how.empty() || entry->section.empty()) << entry->id;
  }
}

TEST(claim_registry, finds_claims_in_any_case_and_suggests) {
  EXPECT_EQ(find_claims({"c3"}).at(0)->id, "C3");
  EXPECT_EQ(find_claims({}).size(), claim_entries().size());
  EXPECT_THROW(find_claims({"C99"}), input_error);
}

TEST(studies, run_every_job_once_and_stop_when_asked) {
  std::vector<int> count(20, 0);
  run_all({}, "jobs", 20, [&](int k) { ++count[static_cast<std::size_t>(k)]; });
  EXPECT_EQ(count, std::vector<int>(20, 1));
  study_control control;
  int done = 0;
  control.stop = [&] { return done >= 3; };
  EXPECT_THROW(run_all(control, "jobs", 20, [&](int) { ++done; }), study_interrupted);
  EXPECT_EQ(done, 3);
}

}  // namespace claims_test
