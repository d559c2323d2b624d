// `apsis reproduce` as a process: verdicts, report, resuming, and failures.
#include "program.hpp"

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace reproduce_test {

namespace {

using app_test::run_apsis;
using app_test::work_folder;
using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

/// Sets an environment variable for the programs that this scope starts.
class environment {
 public:
  environment(const char* name, const char* value) : name_(name) { setenv(name, value, 1); }
  ~environment() { unsetenv(name_); }
  environment(const environment&) = delete;
  environment& operator=(const environment&) = delete;

 private:
  const char* name_;
};

}  // namespace

TEST(reproduce, leaves_a_report_that_needs_no_other_file) {
  const work_folder folder;
  const auto result = run_apsis(folder, {"reproduce", "c12", "C3", "--out", "r"});
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("2 of 2 claims hold"));
  const json document = json::parse(app_test::read(folder.path() / "r" / "reproduce.json"));
  ASSERT_EQ(document["claims"].size(), 2U);
  EXPECT_EQ(document["claims"][0]["id"], "C3");  // in the order of the paper
  const std::string page = app_test::read(folder.path() / "r" / "report.html");
  EXPECT_THAT(page, HasSubstr("data:image/svg+xml;base64,"));
  EXPECT_THAT(page, Not(HasSubstr("src=\"http")));
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "r" / "pictures" / "C12-decay.png"));
}

TEST(reproduce, prints_only_the_document_when_asked_for_json) {
  const work_folder folder;
  const auto result = run_apsis(folder, {"reproduce", "C3", "--out", "r", "--json"});
  EXPECT_EQ(result.code, 0) << result.err;
  const json document = json::parse(result.out);
  EXPECT_TRUE(document["claims"][0]["holds"].get<bool>());
  EXPECT_EQ(document["claims"][0]["findings"][0]["value"], 2.0);
}

TEST(reproduce, resumes_checked_claims_and_rejects_damaged_files) {
  const work_folder folder;
  ASSERT_EQ(run_apsis(folder, {"reproduce", "C3", "--out", "r"}).code, 0);
  const auto file = folder.path() / "r" / "reproduce.json";
  json document = json::parse(app_test::read(file));
  document["claims"][0]["wall_s"] = 1234.5;  // a mark that a repeated check would not have
  std::ofstream(file) << document;
  ASSERT_EQ(run_apsis(folder, {"reproduce", "C3", "C4", "--out", "r", "--resume"}).code, 0);
  document = json::parse(app_test::read(file));
  EXPECT_EQ(document["claims"][0]["wall_s"], 1234.5);
  EXPECT_EQ(document["claims"].size(), 2U);

  document["claims"][0]["holds"] = false;  // claims that did not hold are checked again
  std::ofstream(file) << document;
  ASSERT_EQ(run_apsis(folder, {"reproduce", "C3", "--out", "r", "--resume"}).code, 0);
  EXPECT_NE(json::parse(app_test::read(file))["claims"][0]["wall_s"], 1234.5);

  std::ofstream(file) << "{\"version\": \"0.0";
  const auto refused = run_apsis(folder, {"reproduce", "C3", "--out", "r", "--resume"});
  EXPECT_EQ(refused.code, 2);
  EXPECT_THAT(refused.err, HasSubstr("leave out --resume"));
}

TEST(reproduce, keeps_the_data_where_no_python_draws) {
  const work_folder folder;
  const environment none("APSIS_PYTHON", "/nowhere/python3");
  const auto result = run_apsis(folder, {"reproduce", "C3", "--out", "r"});
  EXPECT_EQ(result.code, 4);
  EXPECT_THAT(result.err, HasSubstr("/nowhere/python3"));
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "r" / "reproduce.json"));
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "r" / "report.html"));
}

TEST(reproduce, an_interrupt_retains_checked_claims) {
  const work_folder folder;
  // All claims take more than a minute, so the signal comes before the last one.
  app_test::process running(folder, {"reproduce", "--threads", "1", "--out", "r"});
  const auto file = folder.path() / "r" / "reproduce.json";
  ASSERT_TRUE(running.wait_until([&] { return std::filesystem::exists(file); }));
  running.send(SIGINT);
  const auto result = running.wait();
  EXPECT_EQ(result.code, 130);
  EXPECT_THAT(result.err, HasSubstr("--resume"));
  const std::size_t kept = json::parse(app_test::read(file))["claims"].size();
  EXPECT_GE(kept, 1U);
  EXPECT_LT(kept, json::parse(run_apsis(folder, {"list", "claims", "--json"}).out).size());
}

TEST(reproduce, the_documentation_has_every_claim_and_no_other) {
  const work_folder folder;
  const json claims = json::parse(run_apsis(folder, {"list", "claims", "--json"}).out);
  const std::string page = app_test::read(std::filesystem::path(APSIS_SOURCE) / "docs" / "claims.md");
  std::size_t rows = 0;
  for (std::size_t at = page.find("\n| C"); at != std::string::npos; at = page.find("\n| C", at + 1)) ++rows;
  EXPECT_EQ(rows, claims.size()) << "write it again: make reproduce, then copy results/reproduce/claims.md";
  for (const auto& claim : claims)
    EXPECT_THAT(page, HasSubstr("| " + claim["name"].get<std::string>() + " | " +
                                claim["description"].get<std::string>() + " |"));
}

}  // namespace reproduce_test
