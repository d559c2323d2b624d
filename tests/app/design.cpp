// The command design as a process.
#include "program.hpp"

#include <cmath>
#include <csignal>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace design_test {

using namespace app_test;
using nlohmann::json;
using testing::HasSubstr;

namespace {

namespace fs = std::filesystem;

std::vector<std::string> design(const std::vector<std::string>& more) {
  std::vector<std::string> arguments = {"design", "--out", "found.toml"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

}  // namespace

TEST(design, writes_a_method_that_can_be_checked_and_used) {
  const work_folder folder;
  const auto arguments =
      design({"--order", "2", "--stages", "3", "--starts", "40", "--time", "3600", "--json"});
  const outcome result = run_apsis(folder, arguments);
  ASSERT_EQ(result.code, 0) << result.err;
  const json found = json::parse(result.out);
  EXPECT_EQ(found["starts"], 40);
  EXPECT_TRUE(found["found"].get<bool>());
  // The largest r is s - 2. Ipopt stops within 1e-9 of it.
  EXPECT_NEAR(found["method"]["ssp_coefficient"].get<double>(), 1.0, 1e-6);
  const outcome check = run_apsis(folder, {"check", "found.toml", "--json"});
  ASSERT_EQ(check.code, 0) << check.err;
  EXPECT_EQ(json::parse(check.out), found["method"]);
  EXPECT_EQ(run_apsis(folder, {"run", "paper/ode", "time.method=found.toml"}).code, 0);
  // A repeated search has the same result.
  const std::string first = read(folder.path() / "found.toml");
  ASSERT_EQ(run_apsis(folder, design({"--order", "2", "--stages", "3", "--starts", "40", "--time", "3600",
                                      "--threads", "1"}))
                .code,
            0);
  EXPECT_EQ(read(folder.path() / "found.toml"), first);
}

TEST(design, writes_a_two_step_method_that_can_be_checked_improved_and_run) {
  const work_folder folder;
  const auto arguments = design({"--steps", "2", "--order", "2", "--stages", "3", "--evaluations", "2",
                                 "--objective", "error", "--ssp", "0.5", "--starts", "40", "--json"});
  const outcome result = run_apsis(folder, arguments);
  ASSERT_EQ(result.code, 0) << result.err;
  const json found = json::parse(result.out);
  EXPECT_EQ(found["method"]["order"], 2);
  EXPECT_EQ(found["method"]["stages"], 3);
  EXPECT_EQ(found["method"]["type"], "A");
  EXPECT_LE(std::abs(found["method"]["second_root"].get<double>()), 0.5);
  EXPECT_GE(found["method"]["ssp_coefficient"].get<double>(), 0.5);
  const outcome check = run_apsis(folder, {"check", "found.toml", "--json"});
  ASSERT_EQ(check.code, 0) << check.err;
  EXPECT_EQ(json::parse(check.out), found["method"]);
  const outcome run = run_apsis(folder, {"run", "paper/ode", "time.method=found.toml"});
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("after 128 steps of found.toml"));
  const outcome drawn = run_apsis(folder, {"plot", "found.toml"});
  EXPECT_EQ(drawn.code, 2);
  EXPECT_THAT(drawn.err, HasSubstr("'found' takes two steps (steps = 2: equal ones"));
  // A search that starts from the method itself ends with one that is no worse.
  const outcome again = run_apsis(
      folder, {"design", "--out", "again.toml", "--steps", "2", "--order", "2", "--stages", "3",
               "--objective", "error", "--ssp", "0.5", "--starts", "1", "--from", "found.toml", "--json"});
  ASSERT_EQ(again.code, 0) << again.err;
  // Ipopt stops within 1e-9 of an optimum.
  EXPECT_LE(json::parse(again.out)["method"]["error_constant"].get<double>(),
            found["method"]["error_constant"].get<double>() * (1.0 + 1e-6));
}

TEST(design, leaves_the_best_so_far_when_interrupted) {
  const work_folder folder;
  process running(folder, design({"--order", "3", "--stages", "6", "--evaluations", "3", "--starts",
                                  "1000000", "--time", "500"}));
  const auto file = folder.path() / "found.toml";
  ASSERT_TRUE(running.wait_until([&] { return fs::exists(file); }));
  running.send(SIGINT);
  const outcome result = running.wait();
  EXPECT_EQ(result.code, 130);
  EXPECT_THAT(result.err, HasSubstr("best method so far is in 'found.toml'"));
  const outcome check = run_apsis(folder, {"check", "found.toml"});
  EXPECT_EQ(check.code, 0) << check.err;
}

TEST(design, writes_a_method_again_with_its_embedded_solution) {
  const work_folder folder;
  const outcome result =
      run_apsis(folder, {"design", "--embedded", "md-imex-chain-7-2", "--out", "with.toml", "--json"});
  ASSERT_EQ(result.code, 0) << result.err;
  const json found = json::parse(result.out);
  EXPECT_TRUE(found["claims_hold"].get<bool>());
  EXPECT_EQ(found["embedded"]["order"], 1);
  EXPECT_EQ(found["embedded"]["implicit_solves"], 1);
  EXPECT_GT(found["embedded"]["estimate"].get<double>(), 0.01);
  const outcome check = run_apsis(folder, {"check", "with.toml", "--json"});
  ASSERT_EQ(check.code, 0) << check.err;
  EXPECT_EQ(json::parse(check.out), found);
  EXPECT_THAT(run_apsis(folder, {"check", "with.toml"}).out, HasSubstr("embedded solution       order 1"));
  // A run to a tolerance takes the embedded solution, or doubles steps.
  const std::vector<std::string> run = {"run", "paper/ode", "time.tolerance=1e-3"};
  const auto with_method = [&run](const std::string& method) {
    auto arguments = run;
    arguments.push_back("time.method=" + method);
    return arguments;
  };
  EXPECT_EQ(run_apsis(folder, with_method("with.toml")).code, 0);
  EXPECT_EQ(run_apsis(folder, with_method("ars-443")).code, 0);
  // check detects a damaged row.
  std::string text = read(folder.path() / "with.toml");
  text.replace(text.rfind("d = \"1/2\""), 9, "d = \"1/3\"");
  folder.file("damaged.toml", text);
  const outcome damaged = run_apsis(folder, {"check", "damaged.toml"});
  EXPECT_EQ(damaged.code, 5);
  EXPECT_THAT(damaged.out, HasSubstr("[embedded] order 1: the condition of tree G is"));
}

TEST(design, removes_stages_and_retains_the_best_method_when_time_is_over) {
  const work_folder folder;
  const outcome smaller = run_apsis(folder, design({"--order", "3", "--stages", "7", "--from",
                                                    "md-imex-8-3-accurate", "--starts", "1", "--json"}));
  ASSERT_EQ(smaller.code, 0) << smaller.err;
  EXPECT_EQ(json::parse(smaller.out)["method"]["stages"], 7);
  EXPECT_EQ(run_apsis(folder, {"check", "found.toml"}).code, 0);
  // Removing one of 16 stages takes seconds, so there is no time for the second.
  const outcome late = run_apsis(folder, {"design", "--order", "4", "--stages", "14", "--time", "0.5",
                                          "--from", "md-imex-16-4-large-r", "--out", "late.toml"});
  EXPECT_EQ(late.code, 3);
  EXPECT_THAT(late.err, HasSubstr("stages remains (the time of"));
}

}  // namespace design_test
