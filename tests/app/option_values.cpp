// Values of options and arguments of all commands, which the test reads from the command definitions.
#include "program.hpp"

#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace option_values_test {

using namespace app_test;
using nlohmann::json;
using testing::HasSubstr;
using testing::IsEmpty;

namespace {

/// An option ("--wall", "FLOAT") or an argument ("CASE", "") of a command.
struct taker {
  std::string command, name, type;
};

std::vector<taker> all_takers() {
  const work_folder folder;
  const json manual = json::parse(run_apsis(folder, {"manual", "--format", "json"}).out);
  std::vector<taker> all;
  for (const auto& command : manual["commands"])
    for (const auto& option : command["options"]) {
      const std::string usage = option["usage"];
      const auto space = usage.find(' ');
      if (usage.front() != '-')
        all.push_back({command["name"], usage, ""});
      else if (space != std::string::npos)
        all.push_back(
            {command["name"], usage.substr(0, space), usage.substr(space + 1, usage.find(':') - space - 1)});
    }
  return all;
}

/// Values for the first option of a type, or for all in the slow test. Options of a type share their parser,
/// so that a few values show whether another option uses it.
std::vector<std::string> bad_values(const taker& t, bool all) {
  std::vector<std::string> values = {""};
  if (t.type.empty()) return values;
  values.emplace_back("--json");
  if (all) values.emplace_back("-x");
  if (t.type == "TEXT") return values;
  if (!all) {
    values.emplace_back(t.type == "FLOAT" ? "nan" : "1.5");
    return values;
  }
  values.insert(values.end(), {"nan", "-nan", "inf", "-inf", "1e400", "-1e400", "ten", "1 2", "0x10", "1,5"});
  if (t.type != "FLOAT") values.insert(values.end(), {"1.5", "99999999999999999999", "1e-3"});
  if (t.type == "UINT") values.emplace_back("-1");
  return values;
}

void expect_refusal(const work_folder& folder, const std::vector<std::string>& arguments,
                    const std::string& says) {
  const auto before = folder.listing();
  const outcome result = run_apsis(folder, arguments);
  EXPECT_EQ(result.code, 2) << result.err;
  EXPECT_THAT(result.err, HasSubstr(says));
  EXPECT_EQ(result.err.find("error: "), result.err.rfind("error: "));
  EXPECT_THAT(result.out, IsEmpty());
  EXPECT_EQ(folder.listing(), before);
}

/// Gives every option and argument values that cannot be meant.
void expect_refusals(bool all) {
  const work_folder folder;
  const std::vector<taker> takers = all_takers();
  std::set<std::string> tried;
  for (const taker& t : takers)
    for (const std::string& value : bad_values(t, all || tried.insert(t.type).second)) {
      SCOPED_TRACE(t.command + " " + t.name + " '" + value + "'");
      std::vector<std::string> arguments = {t.command};
      // The arguments before this one get a word.
      if (t.type.empty())
        for (const taker& other : takers) {
          if (other.command != t.command || !other.type.empty()) continue;
          if (other.name == t.name) break;
          arguments.emplace_back("word");
        }
      else
        arguments.push_back(t.name);
      arguments.push_back(value);
      expect_refusal(folder, arguments, t.name + " cannot be '" + value + "'");
    }
}

}  // namespace

TEST(option_values, the_definitions_name_options_of_every_type) {
  int options = 0, arguments = 0, numbers = 0, integers = 0;
  for (const taker& t : all_takers()) {
    (t.type.empty() ? arguments : options) += 1;
    numbers += t.type == "FLOAT" ? 1 : 0;
    integers += t.type == "INT" || t.type == "UINT" ? 1 : 0;
  }
  // These are the current numbers, half of them of apsis design. Fewer mean that the test no longer
  // reads all definitions.
  EXPECT_GE(options, APSIS_HAS_DESIGN ? 30 : 17);
  EXPECT_GE(arguments, 9);
  EXPECT_GE(numbers, APSIS_HAS_DESIGN ? 8 : 1);
  EXPECT_GE(integers, APSIS_HAS_DESIGN ? 9 : 3);
}

TEST(option_values, that_cannot_be_meant_are_refused_by_the_name_of_the_option) {
  expect_refusals(false);
}

TEST(SLOW_option_values, that_cannot_be_meant_are_refused_by_every_option) {
  expect_refusals(true);
}

TEST(option_values, whole_numbers_may_be_written_as_any_number) {
  const work_folder folder;
  EXPECT_EQ(run_apsis(folder, {"run", "paper/ode", "--threads", "1e0"}).code, 0);
  EXPECT_EQ(run_apsis(folder, {"run", "paper/ode", "--threads", "+01"}).code, 0);
}

TEST(option_values, paths_that_begin_with_a_dash_are_written_with_their_folder) {
  const work_folder folder;
  EXPECT_EQ(run_apsis(folder, {"run", "paper/ode", "--out", "./--json"}).code, 0);
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "--json" / "manifest.json"));
}

}  // namespace option_values_test
