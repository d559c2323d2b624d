// The real program refuses bad input with its exit code and one clear message. It prints nothing to standard
// output and leaves no files behind.
#include <support/bad_input.hpp>

#include "program.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace bad_input_test {

using namespace app_test;
using testing::HasSubstr;
using testing::IsEmpty;

namespace {

const std::string good_case =
    "[model]\nname = \"bgk\"\n[space]\ncells = 20\ndomain = [0.0, 2.0]\n[velocity]\nmax = 15.0\n"
    "points = 100\n[time]\nmethod = \"md-imex-3-2\"\nend = 0.001\ndt = 0.001\n";
const std::string good_method =
    "name = \"m\"\ntitle = \"t\"\ncitation = \"c\"\nkind = \"implicit\"\n[claims]\norder = 2\n"
    "ssp_coefficient = \"unconditional\"\n[shu_osher]\nP = [[]]\n"
    "d = [\"1\"]\nddot = [\"-1/2\"]\n";

/// Returns "a.a.a" with n parts.
std::string many_dots(int n) {
  std::string key = "a";
  for (int i = 1; i < n; ++i) key += ".a";
  return key;
}

void write_files(const work_folder& folder) {
  folder.file("good.toml", good_case);
  folder.file("file", "x");
  folder.file("unknown_key.toml", good_case + "frobnicate = 1\n");
  folder.file("truncated.toml", good_case.substr(0, 40));
  folder.file("garbage.toml", std::string(10'000'000, '\x93'));
  folder.file("binary.toml", std::string("\x7f"
                                         "ELF\x02\x01\x01\0\0\0",
                                         10));
  folder.file("empty.toml", "");
  folder.file("README.md", "# A title\n\nApsis computes flows.\n");
  folder.file("m.toml", good_method);
  std::string wrong = good_method;
  wrong.replace(wrong.find("-1/2"), 4, "-1/3");
  folder.file("wrong_claim.toml", wrong);
  folder.file("truncated_method.toml", good_method.substr(0, 90));
  const auto named = [](const std::string& name) {
    std::string text = good_method;
    const auto begin = text.find("name = \"") + 8;
    return text.replace(begin, text.find('"', begin) - begin, name);
  };
  folder.file("escape.toml", named("../escape"));
  folder.file("unnamed.toml", named(""));
  folder.file("taken.toml", named("md-imex-3-2"));
  folder.file("dots.toml", many_dots(50000) + " = 1\n" + good_method);
  // A megabyte of comments. If the program cut the file there, it would read a method without its last lines.
  folder.file("long.toml", good_method + "#" + std::string(1'100'000, 'x') + "\n");
  std::filesystem::create_directory(folder.path() / "damaged");
  folder.file("damaged/manifest.json", "{");
  folder.file("damaged/fields.csv", "x,rho\n");
  folder.file("no-method.toml", "name = \"x\"\n");
  std::filesystem::create_directory(folder.path() / "stopped");
  folder.file("stopped/checkpoint.h5", "");
  folder.file("not_hdf5.h5", "this is no HDF5 file");
}

/// Runs a command, which must leave no file behind. It prints only an error, or a report if a claim does not
/// hold (exit code 5).
bad_input::answer answer_to(const work_folder& folder, const std::vector<std::string>& arguments) {
  const auto before = folder.listing();
  const outcome result = run_apsis(folder, arguments);
  EXPECT_EQ(folder.listing(), before);
  if (result.code != 5) {
    EXPECT_THAT(result.out, IsEmpty());
  }
  const auto at = result.err.find("error: ");
  EXPECT_NE(at, std::string::npos) << result.err;
  EXPECT_EQ(at, result.err.rfind("error: ")) << result.err;
  const std::string message = at == std::string::npos ? "" : result.err.substr(at + 7);
  return {result.code, message.substr(0, message.find_last_not_of('\n') + 1)};
}

}  // namespace

TEST(bad_input, is_refused_at_its_place_with_its_reason) {
  const work_folder folder;
  write_files(folder);
  auto rows = bad_input::rows_in(APSIS_BAD_INPUT);
  if (!APSIS_HAS_DESIGN)
    std::erase_if(rows, [](const auto& r) { return !r.run.empty() && r.run[0] == "design"; });
  bad_input::expect_answers(rows, [&](const bad_input::row& r) { return answer_to(folder, r.run); });
}

TEST(bad_input, of_many_bytes_or_other_bytes_than_text_is_refused) {
  const work_folder folder;
  write_files(folder);
  const struct {
    std::vector<std::string> arguments;
    int code;
    std::string says;
  } all[] = {{{"run", "good.toml", "title=\xff\xfe", "--out", "o"}, 2, "override"},
             {{"run", "good.toml", "time.end={" + many_dots(50000) + "=1}"}, 2, "at most 4096 are read"},
             {{"run", "good.toml", "--out", "deep/" + std::string(300, 'x')}, 4, "cannot create the folder"}};
  for (const auto& one : all) {
    const auto found = answer_to(folder, one.arguments);
    EXPECT_EQ(found.code, one.code) << one.says;
    EXPECT_THAT(found.message, HasSubstr(one.says));
  }
}

TEST(bad_input, the_files_of_the_table_are_good_where_they_should_be) {
  const work_folder folder;
  write_files(folder);
  EXPECT_EQ(run_apsis(folder, {"run", "good.toml"}).code, 0);
  EXPECT_EQ(run_apsis(folder, {"check", "m.toml"}).code, 0);
  EXPECT_EQ(run_apsis(folder, {"show", "good.toml"}).out, good_case);
}

namespace {

/// Checks a method file that ends after 0, stride, 2 stride … bytes.
void expect_no_crash_with_a_part(std::size_t stride) {
  const work_folder folder;
  for (std::size_t n = 0; n < good_method.size(); n += stride) {
    const outcome result = run_apsis(folder, {"check", folder.file("cut.toml", good_method.substr(0, n))});
    EXPECT_TRUE(result.code == 0 || result.code == 2 || result.code == 5)
        << n << ": " << result.code << result.err;
  }
}

}  // namespace

// tests/method/files.cpp gives the parser every part.
// lines.
TEST(bad_input, a_method_file_cut_at_a_byte_does_not_crash_the_program) {
  expect_no_crash_with_a_part(7);
}

TEST(SLOW_bad_input, a_method_file_cut_at_any_byte_does_not_crash_the_program) {
  expect_no_crash_with_a_part(1);
}

TEST(bad_input, results_of_an_earlier_run_survive_a_failed_start) {
  const work_folder folder;
  write_files(folder);
  ASSERT_EQ(run_apsis(folder, {"run", "good.toml", "--out", "o"}).code, 0);
  const auto before = folder.listing();
  const std::string manifest = read(folder.path() / "o/manifest.json");
  EXPECT_EQ(run_apsis(folder, {"run", "unknown_key.toml", "--out", "o"}).code, 2);
  EXPECT_EQ(run_apsis(folder, {"run", "good.toml", "velocity.max=1.0", "--out", "o"}).code, 2);
  EXPECT_EQ(folder.listing(), before);
  EXPECT_EQ(read(folder.path() / "o/manifest.json"), manifest);
}

TEST(bad_input, a_numerical_failure_retains_the_computed_results_and_reports_it) {
  const work_folder folder;
  write_files(folder);
  // This step of the explicit method is far above its stability limit, dt = O(epsilon).
  const outcome result = run_apsis(folder, {"run", "good.toml", "time.method=ssprk-2-2", "model.epsilon=1e-6",
                                            "time.end=0.5", "time.dt=0.001", "--out", "o"});
  EXPECT_EQ(result.code, 3) << result.err;
  EXPECT_THAT(result.err,
              testing::ContainsRegex(
                  "error: no local equilibrium \\(temperature -.* is not positive\\).*\\[step [0-9]+, t = "));
  EXPECT_THAT(read(folder.path() / "o/manifest.json"), HasSubstr("\"state\": \"failed\""));
  EXPECT_FALSE(read(folder.path() / "o/history.csv").empty());
}

}  // namespace bad_input_test
