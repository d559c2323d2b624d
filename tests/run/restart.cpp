// A run continued from a checkpoint has the bits of an uninterrupted one, for every registered method and
// model. A damaged checkpoint is refused.
#include "same_results.hpp"

#include <apsis/config/case.hpp>
#include <apsis/core/errors.hpp>
#include <apsis/core/version.hpp>
#include <apsis/method/method.hpp>
#include <apsis/method/time_integrator.hpp>
#include <apsis/model/model_registry.hpp>
#include <apsis/output/checkpoint.hpp>
#include <apsis/output/sealed_file.hpp>
#include <apsis/run/session.hpp>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <support/bad_input.hpp>
#include <support/folder.hpp>

namespace restart_test {

using namespace apsis;
using testing::HasSubstr;

namespace {

/// Returns a case of ten steps on a small mesh.
std::string small_case(const model_entry& model, const std::string& method, const std::string& more) {
  std::string text = "[model]\nname = \"" + model.name + "\"\n";
  if (prototype(model).has_relaxation_time()) text += "epsilon = 1e-3\n";
  if (has_space(model)) text += "[space]\ncells = 10\ndomain = [0.0, 2.0]\n";
  if (model.has_velocity_grid) text += "[velocity]\nmax = 9.0\npoints = 36\n";
  text += "[time]\nmethod = \"" + method + "\"\ndt = 0.005\nend = 0.05\n" + more;
  return text + "[output]\nevery = 0.011\n";
}

/// Runs until the total number of steps is `steps`, or to the end. Leaves a checkpoint in the folder.
outcome run(const case_config& c, const std::string& folder, long steps,
            std::optional<std::string> restart = {}) {
  session_options how;
  how.out = folder;
  how.restart = std::move(restart);
  long done = 0;
  how.watch = [&done](const simulation& now) { done = now.step(); };
  how.stop = [&done, steps] { return done >= steps; };
  run_session session(c, how);
  session.run();
  return {session.computed().state(), session.records().history(), session.records().fields()};
}

std::string bytes_of(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

void write_bytes(const std::string& path, const std::string& bytes) {
  std::filesystem::remove(path);  // some file systems flush to disk when a file is overwritten
  std::ofstream(path, std::ios::binary) << bytes;
}

/// Returns the reason why a file is refused, or "" if it is accepted.
std::string refusal(const std::string& path) {
  try {
    static_cast<void>(read_checkpoint(path));
  } catch (const io_error& why) {
    return why.what();
  }
  return {};
}

/// Writes a small checkpoint and returns its path.
std::string some_checkpoint(const test_folder& folder) {
  run(parse_case(small_case(find_model("ode"), "md-imex-3-2", ""), "case"), folder / "some", 2);
  return folder / "some/checkpoint.h5";
}

}  // namespace

class restart : public testing::TestWithParam<std::string> {};

TEST_P(restart, continues_bit_for_bit_with_every_method_from_any_step) {
  const auto& model = find_model(GetParam());
  const test_folder folder;
  std::mt19937 random(7);
  int asked = 0;
  for (const auto& name : integrator_names()) {
    std::optional<case_config> c;
    std::optional<outcome> whole;
    try {
      c = parse_case(small_case(model, name, ""), "case");
      whole = run(*c, folder / "whole", 1000);
    } catch (const input_error& refused) {
      EXPECT_NE(std::string(refused.what()).find("cannot integrate model"), std::string::npos)
          << refused.what();
      continue;
    } catch (const numerical_error& failure) {
      // Explicit methods are unstable beyond Δt = O(ε). No other method may fail.
      EXPECT_EQ(find_method(name).kind, method_kind::explicit_only) << name << ": " << failure.what();
      // An unstable state becomes NaN, or a gas too hot for the velocities.
      EXPECT_THAT(failure.problem(), testing::AnyOf(testing::HasSubstr("a smaller step"),
                                                    testing::HasSubstr("a larger velocity.max")));
      continue;
    }
    ++asked;
    const auto at = std::uniform_int_distribution<long>(0, 9)(random);
    run(*c, folder / "half", at);
    expect_same(*whole, run(*c, folder / "again", 1000, folder / "half/checkpoint.h5"),
                name + " from step " + std::to_string(at));
  }
  EXPECT_GE(asked, 5);
}

INSTANTIATE_TEST_SUITE_P(models, restart, testing::ValuesIn([] {
                           std::vector<std::string> names;
                           for (const auto* entry : model_entries()) names.push_back(entry->name);
                           return names;
                         }()));

TEST(restart_from, a_graded_start_or_a_tolerance_continues_bit_for_bit_from_every_step) {
  const test_folder folder;
  for (const std::string more :
       {"startup = \"graded\"\n", "tolerance = 1e-4\n", "tolerance = 1e-4\ncontroller = \"pid\"\n",
        "tolerance = 1e-4\ncontroller = \"h211b\"\n"}) {
    const auto c = parse_case(small_case(find_model("ode"), "md-imex-8-3", more), "case");
    const auto whole = run(c, folder / "whole", 1000);
    const auto steps = static_cast<long>(whole.history.rows.size()) - 1;
    ASSERT_GE(steps, 10);
    for (long at = 0; at < steps; ++at) {
      run(c, folder / "half", at);
      expect_same(whole, run(c, folder / "again", 1000, folder / "half/checkpoint.h5"), more);
    }
  }
}

TEST(restart_from, a_kill_keeps_the_snapshots_of_the_distribution_even_if_the_continuation_fails) {
  const test_folder folder;
  const auto& model = find_model("relaxation");
  const auto c = parse_case(small_case(model, "md-imex-3-2", "") + "distribution = \"snapshots\"\n", "case");
  run(c, folder / "whole", 1000);
  run(c, folder / "o", 6);
  // Restore the names of files that a killed run leaves.
  std::filesystem::rename(folder / "o/snapshots", folder / "o/.snapshots.partial");
  {
    session_options how;
    how.out = folder / "o";
    how.restart = folder / "o/checkpoint.h5";
    how.watch = [](const simulation&) { throw std::runtime_error("no"); };
    run_session failing(c, how);
    try {
      failing.run();
      ADD_FAILURE() << "it did not fail";
    } catch (const std::runtime_error& thrown) {
      EXPECT_STREQ(thrown.what(), "no");
    }
  }
  run(c, folder / "o", 1000, folder / "o/checkpoint.h5");
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder / "whole/snapshots")) {
    const std::string name = entry.path().filename().string();
    EXPECT_TRUE(bytes_of(entry.path().string()) == bytes_of(folder / ("o/snapshots/" + name))) << name;
    ++files;
  }
  EXPECT_EQ(files, 5U);  // the beginning and the multiples 1 to 4 of 0.011 below 0.05
}

TEST(a_checkpoint, that_was_cut_short_at_any_byte_is_refused) {
  const test_folder folder;
  const std::string path = some_checkpoint(folder), whole = bytes_of(path);
  ASSERT_EQ(refusal(path), "");
  for (std::size_t length = 0; length < whole.size(); ++length) {
    write_bytes(folder / "cut.h5", whole.substr(0, length));
    ASSERT_NE(refusal(folder / "cut.h5"), "") << length;
  }
  EXPECT_THAT(refusal(folder / "cut.h5"), HasSubstr("instead of '" + std::to_string(whole.size())));
  write_bytes(folder / "long.h5", whole + '\0');
  EXPECT_NE(refusal(folder / "long.h5"), "");
}

TEST(a_checkpoint, with_any_bit_flipped_is_refused) {
  const test_folder folder;
  const std::string path = some_checkpoint(folder), whole = bytes_of(path);
  std::mt19937 random(1);
  for (std::size_t at = 0; at < whole.size(); ++at)
    for (unsigned bit = 0; bit < 8; ++bit) {
      // All bits of the seal are flipped, and one bit of each other byte.
      if (at >= seal_length && bit != 0) continue;
      const unsigned which = at < seal_length ? bit : random() % 8;
      std::string changed = whole;
      changed[at] = static_cast<char>(static_cast<unsigned char>(changed[at]) ^ (1U << which));
      write_bytes(folder / "changed.h5", changed);
      ASSERT_NE(refusal(folder / "changed.h5"), "") << "byte " << at << ", bit " << which;
    }
  EXPECT_THAT(refusal(folder / "changed.h5"), HasSubstr("checksum"));
}

TEST(a_checkpoint, of_another_kind_or_version_is_refused_with_the_reason) {
  const test_folder folder;
  bad_input::expect_refused(
      {{[&] { static_cast<void>(read_checkpoint(folder / "none.h5")); }, {"cannot be opened"}, 4}});
  write_bytes(folder / "text.h5", std::string(5000, 'x'));
  bad_input::expect_refused({{[&] { static_cast<void>(read_checkpoint(folder / "text.h5")); },
                              {"its header is missing or damaged"},
                              4}});
  // A checkpoint of another version, valid and sealed.
  const std::string path = some_checkpoint(folder);
  seal(path, "checkpoint", "0.0.7");
  bad_input::expect_refused({{[&] { static_cast<void>(read_checkpoint(path)); },
                              {std::string("written by version 0.0.7, this is ") + version()},
                              4}});
}

TEST(a_checkpoint, that_is_missing_or_another_file_is_an_input_error_before_the_run) {
  const test_folder folder;
  const auto c = parse_case(small_case(find_model("ode"), "md-imex-3-2", ""), "case");
  run(c, folder / "o", 1000);
  const auto restart = [&](const std::string& name) { run(c, folder / "p", 1000, folder / name); };
  write_bytes(folder / "square.toml", "[model]\n");
  std::filesystem::create_directory(folder / "other");
  bad_input::expect_refused(
      {{[&] { restart("none.h5"); },
        {"no checkpoint '" + (folder / "none.h5") +
         "' (there is no such file); give a checkpoint.h5 written by apsis"}},
       {[&] { restart("o"); },
        {"'" + (folder / "o") + "' is not a checkpoint (it is a folder); give " +
         (folder / "o/checkpoint.h5")}},
       {[&] { restart("other"); },
        {"'" + (folder / "other") +
         "' is not a checkpoint (it is a folder); give a checkpoint.h5 written by apsis"}},
       {[&] { restart("square.toml"); },
        {"'" + (folder / "square.toml") +
         "' is not a checkpoint (it is not an HDF5 file); give a checkpoint.h5 written by apsis"}}});
  EXPECT_FALSE(std::filesystem::exists(folder / "p"));
}

TEST(a_checkpoint, of_a_later_time_is_refused_with_both_times_in_seconds_if_the_results_are_in_si_units) {
  const test_folder folder;
  const auto ode = [](const std::string& end) {
    return parse_case(small_case(find_model("ode"), "md-imex-3-2", ""), "case", {"time.end=" + end});
  };
  const auto gas = [](const std::string& end) {
    return load_case("gas/micro-channel",
                     {"output.units=SI", "time.end=" + end, "space.cells=12", "velocity.points=16"});
  };
  run(ode("0.0625"), folder / "ode", 1000);
  run(gas("200 ns"), folder / "gas", 1000);
  // A checkpoint is that of the last step whose length does not depend on the end.
  bad_input::expect_refused(
      {{[&] { run(ode("0.03125"), folder / "ode", 1000, folder / "ode/checkpoint.h5"); },
        {"ode/checkpoint.h5' is already at t = 0.05", " (time.end is 0.03125); give a later time.end"}},
       {[&] { run(gas("100 ps"), folder / "gas", 1000, folder / "gas/checkpoint.h5"); },
        {"gas/checkpoint.h5' is already at t = ", "e-07 s (time.end is ",
         ", or 1e-10 s); give a later time.end"}}});
}

TEST(a_checkpoint, of_another_commit_is_accepted_with_a_warning) {
  const test_folder folder;
  const std::string path = some_checkpoint(folder);
  checkpoint saved = read_checkpoint(path);
  EXPECT_EQ(saved.commit, commit());
  saved.commit = std::string(40, 'a');
  write_checkpoint(folder / "other.h5", saved);
  const auto c = parse_case(small_case(find_model("ode"), "md-imex-3-2", ""), "case");
  testing::internal::CaptureStderr();
  const auto continued = run(c, folder / "again", 1000, folder / "other.h5");
  const std::string said = testing::internal::GetCapturedStderr();
  expect_same(run(c, folder / "whole", 1000), continued, "another commit");
  const bool known = std::string(commit()) != "unknown";
  EXPECT_EQ(said.find("was written by commit " + std::string(40, 'a')) != std::string::npos, known) << said;
}

}  // namespace restart_test
