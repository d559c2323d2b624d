// The progress bar appears only on a terminal.
#include "terminal.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace progress_test {

using namespace app_test;
using nlohmann::json;
using testing::ContainsRegex;
using testing::Each;
using testing::EndsWith;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::SizeIs;

namespace {

const std::string erase_line = "\r\033[K";
constexpr const char* bar = "\\[=*>? *\\] +[0-9]+ %  ([0-9:]+|--) left  ";

/// Returns the texts on the terminal between erasures, including the text before the first and
/// after the last.
std::vector<std::string> drawn(const std::string& text) {
  std::vector<std::string> parts;
  for (std::size_t begin = 0;;) {
    const auto end = text.find(erase_line, begin);
    parts.push_back(text.substr(begin, end - begin));
    if (end == std::string::npos) return parts;
    begin = end + erase_line.size();
  }
}

/// Returns only the texts with a bar.
std::vector<std::string> bars(const std::string& text) {
  std::vector<std::string> found;
  for (const auto& part : drawn(text))
    if (part.starts_with('[')) found.push_back(part);
  return found;
}

const std::vector<std::string> some_run = {"run", "paper/ode", "--threads", "1"};

}  // namespace

TEST(progress, of_a_run_on_a_terminal_is_drawn_with_its_steps_and_erased_at_the_end) {
  const work_folder folder;
  const outcome run = run_on_terminal(folder, some_run, 0);
  ASSERT_EQ(run.code, 0) << run.err;
  ASSERT_THAT(bars(run.err), Not(IsEmpty())) << run.err;
  EXPECT_THAT(bars(run.err),
              Each(ContainsRegex("^" + std::string(bar) + "step [0-9]+/[0-9]+  t = .*  min .*[0-9]$")));
  EXPECT_THAT(run.err, EndsWith(erase_line));
  // The summary is on standard output, without characters of the bar.
  EXPECT_THAT(run.out, HasSubstr("complete"));
  EXPECT_THAT(run.out, Not(HasSubstr("\033")));
}

TEST(progress, never_wraps_so_that_it_can_be_erased) {
  const work_folder folder;
  const outcome run = run_on_terminal(folder, some_run, 40);
  ASSERT_EQ(run.code, 0) << run.err;
  ASSERT_THAT(bars(run.err), Not(IsEmpty())) << run.err;
  // The last column is left free: some terminals wrap as soon as it is written.
  EXPECT_THAT(bars(run.err), Each(SizeIs(39)));
}

TEST(progress, is_silent_without_a_terminal) {
  const work_folder folder;
  const outcome run = run_apsis(folder, some_run);
  ASSERT_EQ(run.code, 0);
  EXPECT_THAT(run.err, Not(HasSubstr("\033")));
  EXPECT_THAT(run.err, Not(HasSubstr(" left  ")));
}

TEST(progress, leaves_json_alone) {
  const work_folder folder;
  auto arguments = some_run;
  arguments.push_back("--json");
  const outcome shown = run_on_terminal(folder, arguments, 80), silent = run_apsis(folder, arguments);
  ASSERT_THAT(bars(shown.err), Not(IsEmpty())) << shown.err;
  const json result = json::parse(shown.out, nullptr, false);
  ASSERT_TRUE(result.is_object()) << shown.out;
  EXPECT_EQ(result["state"], json::parse(silent.out)["state"]);
}

TEST(progress, of_a_study_begins_with_the_number_of_its_runs) {
  const work_folder folder;
  const outcome study = run_on_terminal(
      folder, {"converge", "paper/ode", "--vary", "time.dt=1/16,1/32,1/64", "--threads", "1"}, 0);
  ASSERT_EQ(study.code, 0) << study.err;
  ASSERT_THAT(bars(study.err), Not(IsEmpty())) << study.err;
  // Three steps and the reference.
  EXPECT_THAT(bars(study.err).front(), ContainsRegex("^" + std::string(bar) + "4 runs$"));
  EXPECT_THAT(study.err, EndsWith(erase_line));
}

TEST(progress, is_erased_before_an_error_is_reported) {
  if (!APSIS_HAS_DESIGN) GTEST_SKIP() << "built without the component design, which needs Ipopt";
  const work_folder folder;
  // No method of order 4 has two stages, so every start fails.
  const outcome run = run_on_terminal(
      folder, {"design", "--order", "4", "--stages", "2", "--starts", "3", "--out", "d.toml"}, 0);
  ASSERT_EQ(run.code, 3) << run.err;
  ASSERT_THAT(bars(run.err), Not(IsEmpty())) << run.err;
  const auto parts = drawn(run.err);
  EXPECT_TRUE(parts.back().starts_with("error: no method found")) << run.err;
}

}  // namespace progress_test
