// `apsis plot` and `apsis report` as commands; tests/python/test_plot.py checks the pictures themselves.
#include "program.hpp"

#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace pictures_test {

using namespace app_test;
using testing::HasSubstr;
using testing::StartsWith;

namespace {

namespace fs = std::filesystem;

bool is_png(const fs::path& path) {
  return read(path).starts_with("\x89PNG\r\n");
}

void make_runs(const work_folder& folder) {
  ASSERT_EQ(run_apsis(folder, {"run", "paper/broadwell", "space.cells=10", "--out", "coarse"}).code, 0);
  ASSERT_EQ(run_apsis(folder, {"run", "paper/broadwell", "space.cells=20", "--out", "fine"}).code, 0);
}

}  // namespace

TEST(plot, draws_runs_studies_and_methods_without_the_python_package) {
  const work_folder folder;
  make_runs(folder);
  ASSERT_EQ(run_apsis(folder, {"converge", "paper/ode", "--vary", "time.dt=1/8,1/16", "--out", "study"}).code,
            0);
  ASSERT_EQ(run_apsis(folder, {"show", "md-imex-3-2", "--format", "toml"}).code, 0);
  std::ofstream(folder.path() / "mine.toml")
      << run_apsis(folder, {"show", "md-imex-3-2", "--format", "toml"}).out;
  // A package of the same name in the working directory is not used instead.
  fs::create_directory(folder.path() / "apsis");
  std::ofstream(folder.path() / "apsis" / "__init__.py") << "raise SystemExit(77)\n";
  const auto drawn =
      run_apsis(folder, {"plot", "fine", "study", "ars-222", "mine.toml", "md-imex-chain-7-2"});
  EXPECT_EQ(drawn.code, 0) << drawn.err;
  std::size_t count = 0;
  std::istringstream made(drawn.out);
  for (std::string path; std::getline(made, path); ++count) EXPECT_TRUE(is_png(folder.path() / path)) << path;
  EXPECT_EQ(count, 2U + 1U + 2U + 2U + 2U);
  EXPECT_THAT(drawn.out, HasSubstr("fine/pictures/fields.png\n"));
  EXPECT_THAT(drawn.out, HasSubstr("md-imex-chain-7-2-stability.png\n"));
}

TEST(plot, compares_runs_and_takes_a_format_and_a_folder) {
  const work_folder folder;
  make_runs(folder);
  const auto drawn = run_apsis(folder, {"plot", "--compare", "both", "--format", "svg", "--out", "pictures",
                                        "few cells=coarse", "fine"});
  EXPECT_EQ(drawn.code, 0) << drawn.err;
  EXPECT_THAT(drawn.out, StartsWith("few cells against fine: rho "));
  EXPECT_THAT(read(folder.path() / "pictures" / "both.svg"), HasSubstr("</svg>"));
}

TEST(plot, refuses_to_compare_what_is_no_result) {
  const work_folder folder;
  make_runs(folder);
  fs::create_directory(folder.path() / "empty");
  const auto refused = [&folder](const std::string& what, const std::string& message) {
    const auto compared = run_apsis(folder, {"plot", "--compare", "both", "coarse", what});
    EXPECT_EQ(compared.code, 2) << what;
    EXPECT_THAT(compared.err, HasSubstr(message));
    EXPECT_FALSE(fs::exists(folder.path() / "both.png"));
  };
  refused("fien", "cannot compare 'fien' (no folder of this name); did you mean 'fine'?");
  refused("few=./corse", "cannot compare './corse' (no folder of this name); did you mean './coarse'?");
  refused("elsewhere/fine",
          "cannot compare 'elsewhere/fine' (no folder of this name); give the folders of apsis run --out");
  refused("empty", "cannot compare 'empty' (not a folder of results); give the folders of apsis run --out");
}

TEST(report, is_one_page_and_goes_with_the_results_that_it_reports) {
  const work_folder folder;
  make_runs(folder);
  const auto made = run_apsis(folder, {"report", "fine", "coarse"});
  EXPECT_EQ(made.code, 0) << made.err;
  EXPECT_EQ(made.out, "fine/report.html\ncoarse/report.html\n");
  EXPECT_THAT(read(folder.path() / "fine" / "report.html"), HasSubstr("kept at every step"));
  ASSERT_EQ(run_apsis(folder, {"run", "paper/broadwell", "--out", "fine"}).code, 0);
  EXPECT_FALSE(fs::exists(folder.path() / "fine" / "report.html")) << "a report of results that are gone";
}

TEST(plot, leaves_no_picture_to_a_later_run) {
  const work_folder folder;
  make_runs(folder);
  ASSERT_EQ(run_apsis(folder, {"plot", "fine"}).code, 0);
  ASSERT_EQ(run_apsis(folder, {"report", "fine"}).code, 0);
  const fs::path pictures = folder.path() / "fine" / "pictures";
  ASSERT_TRUE(is_png(pictures / "fields.png"));
  std::ofstream(pictures / "sketch.png") << "mine";
  const auto again = run_apsis(folder, {"run", "paper/broadwell", "space.cells=20", "--out", "fine"});
  EXPECT_EQ(again.code, 0) << again.err;
  EXPECT_FALSE(fs::exists(pictures / "fields.png"));
  EXPECT_FALSE(fs::exists(pictures / "history.png"));
  EXPECT_EQ(read(pictures / "sketch.png"), "mine");
  EXPECT_THAT(again.err,
              HasSubstr("of the earlier run from 'fine/pictures' (they show its results); apsis plot "
                        "fine draws new ones"));
  EXPECT_THAT(again.err,
              HasSubstr("'fine/pictures' has 1 file that apsis did not draw, or that changed since"));
}

}  // namespace pictures_test
