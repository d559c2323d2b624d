// `apsis validate` as a process: verdicts, report, a value for other parameters, and refusals.
#include "program.hpp"

#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace validate_test {

namespace {

using app_test::run_apsis;
using app_test::work_folder;
using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

}  // namespace

TEST(validate, leaves_a_report_that_needs_no_other_file) {
  const work_folder folder;
  const auto result = run_apsis(folder, {"validate", "prandtl", "--out", "v"});
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("3 of 3 reference values are met"));
  const json document = json::parse(app_test::read(folder.path() / "v" / "validate.json"));
  ASSERT_EQ(document["quantities"].size(), 1U);
  for (const auto& value : document["quantities"][0]["values"]) EXPECT_TRUE(value["holds"].get<bool>());
  const std::string page = app_test::read(folder.path() / "v" / "report.html");
  EXPECT_THAT(page, HasSubstr("3 of 3 reference values are met"));
  EXPECT_THAT(page, Not(HasSubstr("src=\"http")));
}

TEST(validate, computes_a_value_for_other_parameters) {
  const work_folder folder;
  const auto result = run_apsis(folder, {"validate", "couette", "delta=2.5", "velocity.points=48", "--json"});
  EXPECT_EQ(result.code, 0) << result.err;
  const json document = json::parse(result.out);
  EXPECT_EQ(document["name"], "couette");
  EXPECT_EQ(document["settings"], (json{"delta=2.5", "velocity.points=48"}));
  EXPECT_EQ(document["warnings"], json::array());
  // The value lies between the reference values at δ = 2 and 5.
  EXPECT_LT(document["value"].get<double>(), 0.4436);
  EXPECT_GT(document["value"].get<double>(), 0.2522);
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "results"));  // nothing is written
}

}  // namespace validate_test
