// Lists, certificates and manuals contain the same facts as text and as JSON.
#include "program.hpp"

#include <map>
#include <set>
#include <sstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace listings_test {

using namespace app_test;
using nlohmann::json;
using testing::HasSubstr;

TEST(listings, lists_and_certificates_are_json) {
  const work_folder folder;
  for (const std::string what :
       {"methods", "models", "cases", "schemes", "formulations", "families", "keys"}) {
    const outcome result = run_apsis(folder, {"list", what, "--json"});
    ASSERT_EQ(result.code, 0) << result.err;
    const json all = json::parse(result.out);
    ASSERT_TRUE(all.is_array());
    EXPECT_GE(all.size(), 2U) << what;
    const outcome text = run_apsis(folder, {"list", what});
    for (const auto& item : all) EXPECT_THAT(text.out, HasSubstr(item["name"].get<std::string>()));
  }
  for (const auto& m : json::parse(run_apsis(folder, {"list", "methods", "--json"}).out))
    EXPECT_TRUE(m["claims_hold"].get<bool>()) << m["name"];
  EXPECT_EQ(run_apsis(folder, {"info", "--json"}).code, 0);
  EXPECT_THAT(run_apsis(folder, {"show", "case"}).out, HasSubstr("checkpoint_every"));
  EXPECT_THAT(run_apsis(folder, {"show", "paper/decay"}).out, HasSubstr("imdrk-2-3"));
}

namespace {

/// Compares the entry of a method in the list with its certificate, its tableau and its file.
void expect_the_method_of_its_entry(const work_folder& folder, const json& m) {
  const std::string name = m["name"].get<std::string>();
  EXPECT_EQ(json::parse(run_apsis(folder, {"check", name, "--json"}).out), m);
  const json shown = json::parse(run_apsis(folder, {"show", name, "--format", "json"}).out);
  EXPECT_EQ(shown["A_hat"].size(), shown["stages"].get<std::size_t>());
  EXPECT_EQ(shown.contains("A"), m["kind"] != "exponential");
  // The file written by `show` is the same method.
  folder.file("m.toml", run_apsis(folder, {"show", name, "--format", "toml"}).out);
  EXPECT_EQ(json::parse(run_apsis(folder, {"check", "m.toml", "--json"}).out), m);
  EXPECT_EQ(run_apsis(folder, {"show", name, "--format", "latex"}).code, 0);
}

}  // namespace

TEST(listings, have_the_certificate_of_a_method_of_each_kind) {
  const work_folder folder;
  std::set<std::string> kinds;
  for (const auto& m : json::parse(run_apsis(folder, {"list", "methods", "--json"}).out))
    if (kinds.insert(m["kind"].get<std::string>()).second) expect_the_method_of_its_entry(folder, m);
  EXPECT_GE(kinds.size(), 4U);
}

TEST(SLOW_listings, have_the_certificate_of_every_method) {
  const work_folder folder;
  for (const auto& m : json::parse(run_apsis(folder, {"list", "methods", "--json"}).out))
    expect_the_method_of_its_entry(folder, m);
}

TEST(listings, keys_and_commands_are_json_with_their_documentation) {
  const work_folder folder;
  std::map<std::string, json> keys;
  for (const auto& key : json::parse(run_apsis(folder, {"list", "keys", "--json"}).out))
    keys[key["name"]] = key;
  EXPECT_EQ(keys["space.limiter"]["choices"], json({"none", "positivity"}));
  EXPECT_EQ(keys["space.limiter"]["default"], "\"none\"");
  EXPECT_EQ(keys["space.cells"]["range"], "at least 1 and at most 10000000");
  EXPECT_TRUE(keys["space.cells"]["required"].get<bool>());
  EXPECT_TRUE(keys["space.cells"]["default"].is_null());
  EXPECT_EQ(keys["velocity.max"]["models"], json({"bgk", "es-bgk", "shakhov"}));
  const std::string text = run_apsis(folder, {"show", "case"}).out;
  for (const auto& [name, key] : keys)
    EXPECT_THAT(text, HasSubstr("\n  " + name.substr(name.find('.') + 1) + " ("));

  const json manual = json::parse(run_apsis(folder, {"manual", "--format", "json"}).out);
  const std::string page = run_apsis(folder, {"manual"}).out;
  std::set<std::string> names;
  for (const auto& command : manual["commands"]) {
    names.insert(command["name"]);
    EXPECT_THAT(page, HasSubstr(".SH apsis " + command["name"].get<std::string>() + "\n"));
    EXPECT_FALSE(command["options"].empty()) << command;
  }
  EXPECT_THAT(names, testing::IsSupersetOf({"run", "converge", "manual"}));
}

TEST(listings, the_list_of_methods_fits_a_wide_terminal_and_names_the_families) {
  const work_folder folder;
  const std::string text = run_apsis(folder, {"list", "methods"}).out;
  std::istringstream lines(text);
  // All characters have one byte, so the number of bytes is the number of columns.
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 130U) << line;
  EXPECT_THAT(text, HasSubstr("md-imex-chain-S-2"));
  EXPECT_THAT(text, HasSubstr("no O(epsilon) plateau"));
  EXPECT_THAT(text, HasSubstr("k = 3, order 3, r = 0\n"));
}

TEST(listings, multistep_methods_are_checked_and_shown) {
  const work_folder folder;
  const json bdf = json::parse(run_apsis(folder, {"check", "imex-bdf-3", "--json"}).out);
  EXPECT_EQ(bdf["order"], 3);
  EXPECT_EQ(bdf["starter"], "extrapolated-euler-3");
  EXPECT_THAT(run_apsis(folder, {"check", "imex-bdf-3"}).out,
              HasSubstr("none: some weights of earlier values are negative"));
  const std::string file = run_apsis(folder, {"show", "two-step-8-3-narrow"}).out;
  folder.file("copy.toml", file);
  EXPECT_EQ(json::parse(run_apsis(folder, {"check", "copy.toml", "--json"}).out),
            json::parse(run_apsis(folder, {"check", "two-step-8-3-narrow", "--json"}).out));
}

TEST(listings, a_member_of_a_family_is_a_method_like_any_other) {
  const work_folder folder;
  const std::string name = "md-imex-chain-7-2";
  const json checked = json::parse(run_apsis(folder, {"check", name, "--json"}).out);
  EXPECT_EQ(checked["ssp_coefficient"], 5.0);
  EXPECT_TRUE(checked["claims_hold"].get<bool>());
  folder.file("m.toml", run_apsis(folder, {"show", name, "--format", "toml"}).out);
  EXPECT_EQ(json::parse(run_apsis(folder, {"check", "m.toml", "--json"}).out), checked);
  EXPECT_EQ(run_apsis(folder, {"run", "paper/ode", "time.method=" + name, "--out", "o"}).code, 0);
  EXPECT_EQ(run_apsis(folder, {"converge", "paper/ode", "--vary", "time.method=md-imex-3-2," + name, "--vary",
                               "time.dt=1/32,1/64", "--reference", "md-imex-6-3@1/512", "--out", "c"})
                .code,
            0);
}

TEST(listings, check_observes_the_limits_of_a_method_that_is_not_in_the_catalogue) {
  const work_folder folder;
  std::string text = run_apsis(folder, {"show", "md-imex-3-2", "--format", "toml"}).out;
  text.replace(text.find("md-imex-3-2"), 11, "my-own-3-2x");
  folder.file("m.toml", text);
  const json checked = json::parse(run_apsis(folder, {"check", "m.toml", "--observe", "--json"}).out);
  ASSERT_GT(checked["observed"].size(), 5U);
  for (const auto& one : checked["observed"]) {
    EXPECT_EQ(one["promised"], 1.0);
    EXPECT_GE(one["kept"].get<double>(), 1.0) << one;
  }
  EXPECT_THAT(run_apsis(folder, {"check", "dirk-2-2", "--observe"}).out, HasSubstr("u' = -10 u^2"));
}

}  // namespace listings_test
