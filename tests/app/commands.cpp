// Commands: one file of app/commands/ suffices.
#include "program.hpp"

#include <algorithm>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace commands_test {

using namespace app_test;
using testing::ContainsRegex;
using testing::HasSubstr;
using testing::UnorderedElementsAreArray;

namespace {

std::vector<std::string> command_files() {
  std::vector<std::string> names;
  for (const auto& file : std::filesystem::directory_iterator(APSIS_SOURCE "/app/commands"))
    if (file.path().extension() == ".cpp") names.push_back(file.path().stem().string());
  return names;
}

/// Returns the first words of the lines below "Subcommands:".
std::vector<std::string> commands_of_the_help() {
  const work_folder folder;
  std::istringstream help(run_apsis(folder, {"--help"}).out);
  std::vector<std::string> names;
  bool below = false;
  for (std::string line; std::getline(help, line);) {
    std::istringstream words(line);
    // Summaries that need a second line are indented further than names.
    if (std::string name; below && line.starts_with("  ") && line[2] != ' ' && words >> name)
      names.push_back(name);
    below = below || line.starts_with("Subcommands:");
  }
  return names;
}

}  // namespace

TEST(commands, of_the_help_are_the_files_of_their_folder) {
  EXPECT_THAT(commands_of_the_help(), UnorderedElementsAreArray(command_files()));
}

TEST(commands, of_the_help_begin_with_those_that_compute) {
  // If the help listed commands in the order of their files, it would begin with check.
  const auto names = commands_of_the_help();
  ASSERT_GE(names.size(), 2U);
  EXPECT_EQ(names[0], "run");
  EXPECT_EQ(names[1], "converge");
}

TEST(commands, have_a_section_of_the_manual_page_and_options_that_bash_completes) {
  const work_folder folder;
  const std::string page = run_apsis(folder, {"manual"}).out;
  const std::string completion = run_apsis(folder, {"manual", "--format", "bash"}).out;
  for (const auto& name : command_files()) {
    EXPECT_THAT(page, HasSubstr(".SH apsis " + name + "\n"));
    EXPECT_THAT(completion, ContainsRegex("\n +" + name + "\\) words='[^']*--help"));
  }
}

TEST(commands, describe_themselves_without_side_effects) {
  const work_folder folder;
  for (const auto& name : command_files()) {
    const outcome help = run_apsis(folder, {name, "--help"});
    EXPECT_EQ(help.code, 0) << name;
    EXPECT_THAT(help.out, HasSubstr("apsis " + name)) << name;
  }
  EXPECT_TRUE(folder.listing().empty());
}

}  // namespace commands_test
