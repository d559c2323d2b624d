// The command sweep as a process.
#include "program.hpp"

#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace sweep_test {

using namespace app_test;
using nlohmann::json;
using testing::HasSubstr;

namespace {
const std::vector<std::string> small = {"sweep",    "gas/couette", "--vary",       "delta=0.1..10",
                                        "--points", "3",           "space.cells=8"};
}  // namespace

TEST(sweep, prints_a_row_for_every_value) {
  const work_folder folder;
  const outcome result = run_apsis(folder, small);
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("parameters.delta  iterations"));
  EXPECT_THAT(result.out, HasSubstr("right_momentum_y"));
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(sweep, writes_a_folder_that_agrees_with_what_it_prints) {
  const work_folder folder;
  const outcome result = run_apsis(folder, with(small, {"--json", "--out", "swept"}));
  ASSERT_EQ(result.code, 0) << result.err;
  const json rows = json::parse(result.out);
  ASSERT_EQ(rows.size(), 3U);
  for (const auto& row : rows) {
    EXPECT_TRUE(row["found"].get<bool>());
    EXPECT_TRUE(row.contains("flux_right_momentum_y"));
  }
  EXPECT_EQ(json::parse(read(folder.path() / "swept" / "sweep.json")).size(), 3U);
  EXPECT_THAT(read(folder.path() / "swept" / "sweep.csv"), HasSubstr("parameters.delta,iterations,cpu_s"));
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "swept" / "sweep.png"));
  ASSERT_EQ(run_apsis(folder, {"report", "swept"}).code, 0);
  const std::string page = read(folder.path() / "swept" / "report.html");
  EXPECT_THAT(page, HasSubstr("3 runs; steady states"));
  EXPECT_THAT(page, HasSubstr("flux_right_momentum_y"));
}

TEST(sweep, names_what_is_not_found) {
  const work_folder folder;
  const outcome result = run_apsis(folder, with(small, {"steady.iterations=2"}));
  EXPECT_EQ(result.code, 3);
  EXPECT_THAT(result.err, HasSubstr("3 steady state(s) are not found"));
  EXPECT_THAT(result.out, HasSubstr("no steady state in 2 iterations"));
}

}  // namespace sweep_test
