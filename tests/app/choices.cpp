// time.method = "auto" and --explain on the command line, and tables whose columns fit their contents.
#include "program.hpp"

#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace choices_test {

using namespace app_test;
using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

namespace {

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

std::vector<std::string> words_of(const std::string& line) {
  std::vector<std::string> words;
  std::istringstream in(line);
  for (std::string word; in >> word;) words.push_back(word);
  return words;
}

const char* const law = R"([model]
name = "relaxation"
epsilon = 1e-3
[space]
cells = 20
domain = [0.0, 2.0]
[time]
end = 0.01
cfl = 0.5
)";

}  // namespace

TEST(list, of_methods_has_a_cell_for_every_column) {
  const work_folder folder;
  const std::string text = run_apsis(folder, {"list", "methods"}).out;
  const auto all = nlohmann::json::parse(run_apsis(folder, {"list", "methods", "--json"}).out);
  ASSERT_GE(all.size(), 40u);
  const auto lines = lines_of(text);
  for (const auto& m : all) {
    const std::string name = m["name"];
    const auto found = std::find_if(lines.begin(), lines.end(),
                                    [&](const std::string& line) { return line.starts_with(name + " "); });
    ASSERT_NE(found, lines.end()) << name;
    // Every row has a name, ten numbers or dashes, the data and the terms of size ε. The last entries may
    // have two words: "any m", "cons. m".
    const auto words = words_of(*found);
    ASSERT_GE(words.size(), 12u) << *found;
    EXPECT_EQ(words[1], std::to_string(m["order"].get<int>())) << *found;
    EXPECT_EQ(words[4], std::to_string(m["implicit_solves"].get<int>())) << *found;
    EXPECT_EQ(words[8], std::to_string(m["buffers"].get<int>())) << *found;
  }
}

TEST(list, of_choices_names_methods_and_the_measurements_behind_them) {
  const work_folder folder;
  const auto all = nlohmann::json::parse(run_apsis(folder, {"list", "choices", "--json"}).out);
  ASSERT_GE(all.size(), 6u);
  for (const auto& row : all)
    EXPECT_THAT(row["origin"].get<std::string>(),
                AnyOf(HasSubstr("contests"), HasSubstr("flows"), HasSubstr("stiff systems")));
  EXPECT_THAT(run_apsis(folder, {"list", "choices"}).out, HasSubstr("md-imex-8-3-mixed"));
}

TEST(run, without_a_method_states_the_choice_in_the_first_line_of_its_log) {
  const work_folder folder;
  folder.file("law.toml", law);
  const auto result = run_apsis(folder, {"run", "law.toml", "--json", "--out", "r"});
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_THAT(
      lines_of(result.err).front(),
      StartsWith("info: law.toml: time.method = \"auto\" is md-imex-8-3-mixed (equal steps on a mesh, "));
  const auto out = nlohmann::json::parse(result.out);
  EXPECT_EQ(out["method"], "md-imex-8-3-mixed");
  EXPECT_EQ(out["method_given"], "auto");
  EXPECT_THAT(out["method_reason"].get<std::string>(), StartsWith("equal steps on a mesh"));
}

TEST(run, restarts_with_the_method_of_the_checkpoint_where_the_program_chose_it) {
  const work_folder folder;
  folder.file("law.toml", law);
  // The method differs from the choice, as after a start by a program with another table of choices.
  ASSERT_EQ(run_apsis(folder, {"run", "law.toml", "time.method=md-imex-5-2", "--out", "r"}).code, 0);
  const auto later =
      run_apsis(folder, {"run", "law.toml", "time.end=0.02", "--restart", "r/checkpoint.h5", "--out", "r"});
  ASSERT_EQ(later.code, 0) << later.err;
  EXPECT_THAT(lines_of(later.err).front(), HasSubstr("is md-imex-5-2 (the method of the checkpoint)"));
  // A method that the case names must be that of the checkpoint.
  const auto other = run_apsis(folder, {"run", "law.toml", "time.method=md-imex-3-2", "time.end=0.03",
                                        "--restart", "r/checkpoint.h5"});
  EXPECT_EQ(other.code, 2);
  EXPECT_THAT(other.err, HasSubstr("belongs to another case"));
}

TEST(run, explains_which_values_are_given_and_which_are_defaults) {
  const work_folder folder;
  folder.file("law.toml", law);
  const auto result = run_apsis(folder, {"run", "law.toml", "--explain", "space.limiter=none"});
  ASSERT_EQ(result.code, 0) << result.err;
  const auto origin_of = [&](const std::string& key) -> std::string {
    for (const auto& line : lines_of(result.err))
      if (line.starts_with(key + " = ")) {
        const auto words = words_of(line);
        for (const char* origin : {"given", "default", "derived"})
          if (std::find(words.begin(), words.end(), origin) != words.end()) return origin;
      }
    return "missing";
  };
  EXPECT_EQ(origin_of("space.cells"), "given");
  EXPECT_EQ(origin_of("space.limiter"), "given");
  EXPECT_EQ(origin_of("space.reconstruction"), "default");
  EXPECT_EQ(origin_of("model.speed"), "default");
  EXPECT_EQ(origin_of("time.method"), "derived");
  EXPECT_THAT(lines_of(result.err).front(), HasSubstr("\"auto\""));
}

}  // namespace choices_test
