// In a program without Ipopt, apsis design ends with exit code 2 and a message that says so,
// whatever its arguments.
#include "command_registry.hpp"

#include <apsis/core/errors.hpp>

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace apsis::app {
extern const command_entry command_design;
}  // namespace apsis::app

namespace {

TEST(without_design, the_command_says_that_it_is_missing) {
  const std::vector<std::vector<std::string>> lines = {
      {"design"},
      {"design", "--order", "2", "--stages", "3", "--out", "d.toml"},
      {"design", "--embedded", "m"}};
  for (const auto& line : lines) {
    CLI::App program;
    CLI::App* command = program.add_subcommand(apsis::app::command_design.name);
    const auto run = apsis::app::command_design.define(*command);
    program.parse(std::vector<std::string>(line.rbegin(), line.rend()));  // CLI11 expects the reverse order
    ASSERT_TRUE(command->parsed());
    try {
      run();
      FAIL() << "the command ran";
    } catch (const apsis::error& refusal) {
      EXPECT_EQ(refusal.code(), apsis::exit_code::input);
      EXPECT_THAT(refusal.what(), testing::HasSubstr("built without Ipopt"));
    }
  }
}

}  // namespace
