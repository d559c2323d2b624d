// The command converge as a process.
#include "program.hpp"

#include <csignal>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace converge_test {

using namespace app_test;
using nlohmann::json;
using testing::HasSubstr;
using testing::IsEmpty;

namespace {

namespace fs = std::filesystem;

const std::vector<std::string> small = {"converge", "paper/ode",         "--vary", "model.epsilon=1,1e-10",
                                        "--vary",   "time.dt=1/16..1/64"};

/// Returns the rows without the columns that differ between two identical runs.
json without_times(json rows) {
  for (auto& row : rows)
    for (const char* time : {"wall_s", "cpu_s"}) row.erase(time);
  return rows;
}

}  // namespace

TEST(converge, prints_only_an_array) {
  const work_folder folder;
  const outcome result = run_apsis(folder, with(small, {"--json"}));
  ASSERT_EQ(result.code, 0) << result.err;
  const json rows = json::parse(result.out);
  ASSERT_EQ(rows.size(), 6U);
  for (const auto& row : rows)
    for (const std::string key :
         {"model.epsilon", "time.dt", "error", "rate", "steps", "dt", "wall_s", "cpu_s", "min_value"})
      EXPECT_TRUE(row.contains(key)) << key;
  // The errors against the next finer run decrease with order 3, up to terms of higher order.
  EXPECT_NEAR(rows[2]["rate"].get<double>(), 3.0, 0.15);
  EXPECT_NEAR(rows[5]["rate"].get<double>(), 3.0, 0.15);
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

TEST(converge, writes_a_folder_that_agrees_with_what_it_prints) {
  const work_folder folder;
  const outcome result = run_apsis(folder, with(small, {"--json", "--out", "o"}));
  ASSERT_EQ(result.code, 0) << result.err;
  const json rows = json::parse(result.out);
  EXPECT_EQ(json::parse(read(folder.path() / "o/converge.json")), rows);
  std::istringstream csv(read(folder.path() / "o/converge.csv"));
  std::string line;
  std::getline(csv, line);
  EXPECT_EQ(line, "model.epsilon,time.dt,error,rate,steps,dt,wall_s,cpu_s,min_value,problem");
  for (const auto& row : rows) {
    std::getline(csv, line);
    std::istringstream cells(line);
    std::string cell;
    for (const std::string key : {"model.epsilon", "time.dt", "error"}) {
      std::getline(cells, cell, ',');
      EXPECT_EQ(std::stod(cell), row[key].get<double>()) << key;
    }
  }
  const json picture = json::parse(read(folder.path() / "o/picture.json"));
  EXPECT_EQ(picture["panels"][0]["curves"].size(), 2U);
  EXPECT_EQ(picture["panels"][0]["curves"][1]["y"][2].get<double>(), rows[5]["error"].get<double>());
  const json manifest = json::parse(read(folder.path() / "o/manifest.json"));
  EXPECT_EQ(manifest["state"], "complete");
  EXPECT_EQ(manifest["study"]["runs"], 8);
}

TEST(converge, does_not_depend_on_threads) {
  const work_folder folder;
  const auto rows = [&](const std::string& threads) {
    return without_times(json::parse(run_apsis(folder, with(small, {"--json", "--threads", threads})).out));
  };
  EXPECT_EQ(rows("1"), rows("3"));
}

TEST(converge, a_picture_is_drawn_or_its_absence_is_reported) {
  const work_folder folder;
  const outcome result = run_apsis(folder, with(small, {"--out", "o"}));
  EXPECT_EQ(result.code, 0);
  if (fs::exists(folder.path() / "o/converge.png"))
    EXPECT_EQ(read(folder.path() / "o/converge.png").substr(1, 3), "PNG");
  else
    EXPECT_THAT(result.err, HasSubstr("draw"));
}

TEST(converge, a_failed_run_is_a_row_and_gives_exit_code_3) {
  const work_folder folder;
  // The step of the explicit method is far beyond its stability limit, so its values overflow.
  const outcome result = run_apsis(
      folder, {"converge", "paper/ode", "model.epsilon=1e-6", "--vary", "time.method=ssprk-3-3,md-imex-6-3",
               "--vary", "time.dt=1/128,1/256", "--reference", "md-imex-6-3@1/1024", "--json", "--out", "o"});
  EXPECT_EQ(result.code, 3) << result.err;
  const json rows = json::parse(result.out);
  ASSERT_EQ(rows.size(), 4U);
  EXPECT_TRUE(rows[0]["error"].is_null());
  EXPECT_THAT(rows[0]["problem"].get<std::string>(), HasSubstr("finite"));
  EXPECT_TRUE(rows[3]["error"].is_number());
  EXPECT_EQ(json::parse(read(folder.path() / "o/converge.json")), rows);
  EXPECT_EQ(json::parse(read(folder.path() / "o/manifest.json"))["state"], "some runs failed");
}

TEST(converge, an_interrupt_retains_finished_runs) {
  const work_folder folder;
  // Fifty runs in succession take several seconds on any machine.
  process run(folder, {"converge", "paper/bgk-accuracy", "velocity.points=100", "time.end=0.3", "--threads",
                       "1", "--vary", "space.cells=24", "--vary",
                       "model.epsilon=1,2,3,4,5,6,7,8,9,10,11,12,13,14,15,16,17,18,19,20,21,22,23,24,25",
                       "--reference", "time", "--out", "o"});
  ASSERT_TRUE(run.wait_until([&] { return run.said().find("50 runs") != std::string::npos; }));
  run.send(SIGINT);
  const outcome stopped = run.wait();
  ASSERT_EQ(stopped.code, 130) << stopped.err;
  EXPECT_THAT(stopped.err, HasSubstr("interrupted"));
  EXPECT_EQ(json::parse(read(folder.path() / "o/manifest.json"))["state"], "interrupted");
  EXPECT_LT(json::parse(read(folder.path() / "o/converge.json")).size(), 25U);
  for (const auto& entry : fs::directory_iterator(folder.path() / "o"))
    EXPECT_NE(entry.path().filename().string().front(), '.') << entry.path();
}

TEST(converge, rejects_an_impossible_folder_before_it_computes) {
  const work_folder folder;
  folder.file("file", "x");
  EXPECT_EQ(run_apsis(folder, with(small, {"--out", "file"})).code, 4);
}

TEST(converge, options_may_stand_before_the_keys) {
  const work_folder folder;
  const outcome result = run_apsis(
      folder, {"converge", "--vary", "time.dt=1/8,1/16", "paper/ode", "model.epsilon=1e-2", "--json"});
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_EQ(json::parse(result.out).size(), 2U);
}

}  // namespace converge_test
