// Bad input to the real program: exit code, one clear message, nothing on standard output, no files
// left behind.
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

struct bad_input {
  std::string name;
  std::vector<std::string> arguments;
  int code;
  std::string says;
};

void PrintTo(const bad_input& b, std::ostream* out) {
  *out << b.name;
}

class bad_inputs : public testing::TestWithParam<bad_input> {};

/// "a.a.a", n parts.
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
  // A megabyte of comments: if the file were truncated there, the rest would be a method without its
  // last lines.
  folder.file("long.toml", good_method + "#" + std::string(1'100'000, 'x') + "\n");
  folder.file("not_hdf5.h5", "this is no HDF5 file");
}

TEST_P(bad_inputs, give_one_message_and_leave_nothing) {
  const work_folder folder;
  write_files(folder);
  const auto before = folder.listing();
  const outcome result = run_apsis(folder, GetParam().arguments);
  EXPECT_EQ(result.code, GetParam().code) << result.err;
  EXPECT_THAT(result.err, HasSubstr("error: "));
  EXPECT_THAT(result.err, HasSubstr(GetParam().says));
  if (GetParam().code != 5) {
    EXPECT_THAT(result.out, IsEmpty());
  }
  EXPECT_EQ(folder.listing(), before);
}

const std::vector<bad_input> all = {
    {"no_command",
     {},
     2,
     "valid: run, converge, list, show, scales, check, reproduce, validate, design, plot, report, info"},
    {"unknown_command", {"rnu", "good.toml"}, 2, "did you mean 'run'?"},
    {"unknown_option", {"run", "good.toml", "--thread", "2"}, 2, "did you mean '--threads'?"},
    {"no_case", {"run"}, 2, "CASE"},
    {"threads_of_text", {"run", "good.toml", "--threads", "two"}, 2, "--threads"},
    {"threads_negative", {"run", "good.toml", "--threads", "-2"}, 2, "--threads"},
    {"threads_too_many", {"run", "good.toml", "--threads", "257"}, 2, "257 not in range 0 to 256"},
    {"velocities_beyond_numbers",
     {"run", "paper/bgk-mixed", "model.velocity_dimensions=3", "velocity.points=1291"},
     2,
     "velocity.points = 1291 are 2.152e+09 velocities in 3 dimensions"},
    {"wall_negative", {"run", "good.toml", "--wall", "-1"}, 2, "--wall"},
    {"wall_without_value", {"run", "good.toml", "--wall"}, 2, "--wall"},
    {"unknown_list", {"list", "metods"}, 2, "did you mean 'methods'?"},
    {"unknown_format", {"show", "imdrk-1-2", "--format", "yaml"}, 2, "--format"},
    {"family_to_show", {"show", "md-imex-chain-2-2"}, 2, "md-imex-chain-S-2 has S from 3 to 64"},
    {"family_to_check", {"check", "md-imex-chain-65-2"}, 2, "md-imex-chain-S-2 has S from 3 to 64"},
    {"unknown_to_show", {"show", "md-imex-3-3"}, 2, "did you mean 'md-imex-3-2'?"},
    {"format_of_a_case", {"show", "case", "--format", "json"}, 2, "leave it out"},
    {"unknown_method_to_check", {"check", "imdrk-1-3"}, 2, "did you mean 'imdrk-1-2'?"},
    {"missing_case", {"run", "paper/bgk-mixd", "--out", "o"}, 2, "did you mean 'paper/bgk-mixed'?"},
    {"folder_as_case", {"run", "."}, 4, "cannot read '.'"},
    {"unknown_key",
     {"run", "unknown_key.toml", "--out", "o"},
     2,
     "unknown_key.toml:13:1: unknown key 'time.frobnicate'"},
    {"truncated_case", {"run", "truncated.toml", "--out", "o"}, 2, "truncated.toml:"},
    {"garbage",
     {"run", "garbage.toml", "--out", "o"},
     2,
     "garbage.toml:1:1000001: the file is larger than 1 MB"},
    {"binary", {"run", "binary.toml", "--out", "o"}, 2, "binary.toml:1:"},
    {"empty", {"run", "empty.toml", "--out", "o"}, 2, "empty.toml:1:1: key 'model.name' is missing"},
    {"bad_override",
     {"run", "good.toml", "space.cels=3", "--out", "o"},
     2,
     "override 'space.cels=3': unknown key"},
    {"unknown_collisions",
     {"run", "paper/bgk-mixed", "space.collisions=edges"},
     2,
     "'space.collisions' is the text 'edges' (there is no such name); valid: gauss, centres"},
    {"centres_of_few_cells",
     {"run", "paper/bgk-mixed", "space.cells=6", "space.collisions=centres"},
     2,
     "override 'space.cells=6': space.cells: 6 cells (values at their centres depend on 6 neighbours)"},
    {"centres_of_point_values",
     {"run", "paper/bgk-mixed-fd", "space.collisions=centres"},
     2,
     "point values collide where they are"},
    {"override_without_value", {"run", "good.toml", "cells", "--out", "o"}, 2, "not of the form key=value"},
    {"nan_override", {"run", "good.toml", "time.end=nan", "--out", "o"}, 2, "must be finite"},
    {"not_utf8_override", {"run", "good.toml", "title=\xff\xfe", "--out", "o"}, 2, "override"},
    {"grid_below_stencil", {"run", "good.toml", "space.cells=3", "--out", "o"}, 2, "stencil"},
    {"velocity_too_small", {"run", "good.toml", "velocity.max=2.0", "--out", "o"}, 2, "velocity.max"},
    {"velocity_too_coarse", {"run", "good.toml", "velocity.points=4", "--out", "o"}, 2, "velocity"},
    {"implicit_only_with_transport",
     {"run", "good.toml", "time.method=imdrk-2-3", "--out", "o"},
     2,
     "implicit only"},
    {"safety_without_ssp",
     {"run", "good.toml", "time.safety=0.5", "time.method=dirk-2-2", "--out", "o"},
     2,
     "dirk-2-2"},
    {"cfl_without_space", {"run", "paper/ode", "time.cfl=0.5", "--out", "o"}, 2, "has no space"},
    {"negative_epsilon", {"run", "good.toml", "model.epsilon=-1", "--out", "o"}, 2, "not negative"},
    {"epsilon_syntax", {"run", "good.toml", "model.epsilon=1+", "--out", "o"}, 2, "ends too early"},
    {"out_below_a_file", {"run", "good.toml", "--out", "file/o"}, 4, "cannot create the folder"},
    {"out_is_a_file", {"run", "good.toml", "--out", "file"}, 4, "cannot create the folder"},
    {"out_in_proc", {"run", "good.toml", "--out", "/proc/apsis/o"}, 4, "cannot create the folder"},
    {"out_name_too_long",
     {"run", "good.toml", "--out", "deep/" + std::string(300, 'x')},
     4,
     "cannot create the folder"},
    {"restart_missing", {"run", "good.toml", "--restart", "none.h5", "--out", "o"}, 4, "cannot be opened"},
    {"restart_not_hdf5",
     {"run", "good.toml", "--restart", "not_hdf5.h5", "--out", "o"},
     4,
     "its header is missing or damaged"},
    {"wrong_claim", {"check", "wrong_claim.toml"}, 5, "do not hold"},
    {"wrong_claim_json", {"check", "wrong_claim.toml", "--json"}, 5, "do not hold"},
    {"case_as_method", {"check", "good.toml"}, 2, ": a case is no method (it has a table [model])"},
    {"truncated_method", {"check", "truncated_method.toml"}, 2, "truncated_method.toml:"},
    {"garbage_method", {"check", "garbage.toml"}, 2, "garbage.toml"},
    {"empty_method", {"check", "empty.toml"}, 2, "empty.toml"},
    {"method_named_by_a_path", {"check", "escape.toml"}, 2, "the name cannot be used"},
    {"method_without_name", {"check", "unnamed.toml"}, 2, "unnamed.toml:1:8: the name is empty"},
    {"run_with_a_taken_name",
     {"run", "paper/ode", "time.method=taken.toml"},
     2,
     "the name 'md-imex-3-2' is taken"},
    {"method_with_many_dots", {"check", "dots.toml"}, 2, "dots.toml:1:16: the key has more than 8 parts"},
    {"case_with_many_dots", {"run", "dots.toml"}, 2, "dots.toml:1:4097: the line is longer than 4096 bytes"},
    {"value_of_many_parts",
     {"run", "good.toml", "time.end={" + many_dots(50000) + "=1}"},
     2,
     "at most 4096 are read"},
    {"method_of_many_bytes", {"check", "long.toml"}, 2, "the file is larger than 1048576 bytes"},
    {"folder_as_method", {"check", "."}, 4, "cannot read"},
};

}  // namespace

INSTANTIATE_TEST_SUITE_P(table, bad_inputs, testing::ValuesIn(all),
                         [](const auto& b) { return b.param.name; });

TEST(bad_input, the_files_of_the_table_are_good_where_they_should_be) {
  const work_folder folder;
  write_files(folder);
  EXPECT_EQ(run_apsis(folder, {"run", "good.toml"}).code, 0);
  EXPECT_EQ(run_apsis(folder, {"check", "m.toml"}).code, 0);
}

TEST(bad_input, a_method_file_cut_at_any_byte_never_crashes) {
  const work_folder folder;
  for (std::size_t n = 0; n < good_method.size(); ++n) {
    const outcome result = run_apsis(folder, {"check", folder.file("cut.toml", good_method.substr(0, n))});
    EXPECT_TRUE(result.code == 0 || result.code == 2 || result.code == 5)
        << n << ": " << result.code << result.err;
  }
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
  // The explicit method far above its stability limit of dt = O(epsilon).
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
