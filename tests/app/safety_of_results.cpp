// The results of a user survive full disks, closed terminals, two runs in one folder, and runs that need more
// memory or more steps than available.
#include "program.hpp"

#include <apsis/core/version.hpp>
#include <apsis/output/hdf5_file.hpp>

#include <csignal>
#include <cstdlib>
#include <iterator>
#include <memory>
#include <sstream>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace safety_of_results_test {

using namespace app_test;
using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
namespace fs = std::filesystem;

namespace {

/// Runs a line of sh in the folder. $APSIS is the program; its output is in files.
outcome shell(const work_folder& folder, const std::string& line) {
  folder.file("line.sh", "APSIS='" + std::string(APSIS_PROGRAM) + "'\ncd '" + folder.path().string() +
                             "' || exit 99\n{ " + line + "\n} > out.txt 2> err.txt\n");
  const int status = std::system(("sh '" + (folder.path() / "line.sh").string() + "'").c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status), read(folder.path() / "out.txt"),
          read(folder.path() / "err.txt")};
}

const std::string gas = "paper/bgk-mixed space.cells=20 velocity.points=100";
const std::vector<std::string> endless = {"run", "paper/bgk-mixed", "space.cells=20", "velocity.points=100",
                                          "time.end=5000.0"};

std::vector<std::string> into(std::vector<std::string> arguments, const std::string& folder) {
  arguments.insert(arguments.end(), {"--out", folder});
  return arguments;
}

/// Waits for a condition that will become true. The wait has no time limit.
template <class Condition>
void await(const Condition& happened) {
  while (!happened()) std::this_thread::sleep_for(std::chrono::milliseconds(5));
}

/// Writes beyond a limit of the file size, and ends the process with code 41 and the message of the error.
[[noreturn]] void write_beyond_a_limit(const std::string& path) {
  std::signal(SIGXFSZ, SIG_IGN);
  const rlimit small{4096, 4096};
  setrlimit(RLIMIT_FSIZE, &small);
  try {
    auto file = apsis::hdf5_file::create(path);
    const std::vector<double> values(100000, 1.0);
    for (int k = 0; k < 20; ++k) file.write("group/data" + std::to_string(k), values, {100000});
    file.close();
  } catch (const std::exception& why) {
    std::fputs(why.what(), stderr);
    std::exit(41);
  }
  std::exit(0);
}

}  // namespace

TEST(a_full_disk, is_an_output_error_in_every_file_and_leaves_the_earlier_results_alone) {
  const work_folder folder;
  ASSERT_EQ(shell(folder, "$APSIS run " + gas + " time.end=0.002 --out o").code, 0);
  // A limit of the file size acts as a full disk. The limits, in units of 512 bytes, range from one that
  // stops the first file to one that stops only the last HDF5 file.
  for (const int blocks : {1, 8, 20, 36}) {
    const outcome full = shell(
        folder, "ulimit -f " + std::to_string(blocks) + "; $APSIS run " + gas + " time.end=0.01 --out o");
    EXPECT_EQ(full.code, 4) << blocks << full.err;
    EXPECT_THAT(read(folder.path() / "err.txt"),
                testing::AnyOf(HasSubstr("File too large"), HasSubstr("no space left")))
        << blocks;
    for (const std::string name : {"manifest.json", "solution.h5", "history.csv"})
      EXPECT_TRUE(fs::exists(folder.path() / "o" / name)) << blocks << name;
    for (const auto& entry : fs::directory_iterator(folder.path() / "o"))
      EXPECT_NE(entry.path().filename().string().front(), '.') << entry.path();
  }
}

TEST(a_full_disk, ends_an_hdf5_file_without_a_crash_at_the_end_of_the_process) {
  const work_folder folder;
  const std::string path = (folder.path() / "x.h5").string();
  // HDF5 used to crash at the end of the process, so the test needs a process of its own.
  EXPECT_EXIT(write_beyond_a_limit(path), testing::ExitedWithCode(41), "File too large");
}

TEST(a_full_disk, leaves_no_folder_of_a_drawing_behind) {
  const work_folder folder, temporary;
  folder.file("python", "#!/bin/sh\nexit 0\n");  // replaces Python, and finds all its modules
  fs::permissions(folder.path() / "python", fs::perms::owner_all);
  const outcome full = shell(folder, "export TMPDIR='" + temporary.path().string() +
                                         "' APSIS_PYTHON=./python; ulimit -f 1; $APSIS plot imdrk-1-2");
  EXPECT_EQ(full.code, 4) << full.err;
  EXPECT_THAT(full.err, AllOf(HasSubstr("File too large"), HasSubstr("set TMPDIR to a folder with space")));
  EXPECT_TRUE(fs::is_empty(temporary.path()));
}

TEST(unwritable_messages, do_not_change_how_the_program_ends) {
  const work_folder folder;
  ASSERT_TRUE(fs::exists("/dev/full")) << "every Linux has it";
  EXPECT_EQ(shell(folder, "$APSIS run nonsense 2> /dev/full").code, 2);
  EXPECT_EQ(shell(folder, "$APSIS run paper/ode --out o 2> /dev/full").code, 0);
  EXPECT_EQ(shell(folder, "$APSIS run nonsense 2>&-").code, 2);
  EXPECT_EQ(shell(folder, "$APSIS list models > /dev/full").code, 4);
  EXPECT_EQ(shell(folder, "$APSIS list models >&-").code, 4);
  EXPECT_EQ(shell(folder, "$APSIS run paper/ode > /dev/full 2> /dev/full").code, 4);
}

TEST(unwritable_messages, do_not_end_up_in_results) {
  const work_folder folder;
  // Without descriptors 1 and 2 the first files of the run would get these numbers.
  EXPECT_EQ(shell(folder, "$APSIS run paper/ode --out o >&- 2>&-").code, 4);
  for (const std::string name : {"manifest.json", "history.csv", "fields.csv", "solution.xdmf"})
    EXPECT_THAT(read(folder.path() / "o" / name), Not(HasSubstr("info: "))) << name;
  EXPECT_EQ(json::parse(read(folder.path() / "o/manifest.json"))["state"], "complete");
}

TEST(a_result_folder, belongs_to_one_run_at_a_time) {
  const work_folder folder;
  process first(folder, into(endless, "o"));
  await([&] { return read(folder.path() / "o/.lock").find('\n') != std::string::npos; });
  for (const std::string what :
       {"run paper/ode --out o", "run paper/ode --out ./o/",
        "converge paper/ode --vary time.dt=1/8,1/16 --reference md-imex-6-3@1/64 --out o"}) {
    const outcome second = shell(folder, "$APSIS " + what);
    EXPECT_EQ(second.code, 4) << what << second.err;
    EXPECT_THAT(second.err, AllOf(HasSubstr("is in use (process "), HasSubstr("wait for that run to end")))
        << what;
  }
  // The end of a killed process releases the folder, even if files remain.
  first.send(SIGKILL);
  EXPECT_EQ(first.wait().code, 1000 + SIGKILL);
  EXPECT_TRUE(fs::exists(folder.path() / "o/.lock"));
  EXPECT_EQ(shell(folder, "$APSIS run paper/ode --out o").code, 0);
  EXPECT_FALSE(fs::exists(folder.path() / "o/.lock"));
}

TEST(a_result_folder, has_the_files_of_one_run_in_any_order_of_arrival) {
  const work_folder folder;
  for (int round = 0; round < 5; ++round) {
    const std::string name = "o" + std::to_string(round);
    std::vector<std::unique_ptr<process>> runs;
    for (int k = 0; k < 6; ++k)
      runs.push_back(std::make_unique<process>(
          folder, std::vector<std::string>{"run", "paper/ode", "time.dt=1/" + std::to_string(64 + k), "--out",
                                           name}));
    int finished = 0;
    for (auto& run : runs) {
      const outcome result = run->wait();
      EXPECT_TRUE(result.code == 0 || result.code == 4) << result.code << result.err;
      if (result.code == 0) ++finished;
    }
    EXPECT_GE(finished, 1);
    const fs::path o = folder.path() / name;
    const std::string manifest = read(o / "manifest.json");
    const auto solution = apsis::hdf5_file::open((o / "solution.h5").string());
    EXPECT_EQ(solution.read_text_attribute("manifest"), manifest);
    std::istringstream history(read(o / "history.csv"));
    long lines = 0;
    for (std::string line; std::getline(history, line);) ++lines;
    EXPECT_EQ(lines, 2 + json::parse(manifest)["result"]["steps"].get<long>());
  }
}

TEST(a_hangup, is_ignored_under_nohup) {
  const work_folder folder;
  process run(
      folder,
      {"run", "paper/bgk-mixed", "space.cells=20", "velocity.points=100", "time.end=0.05", "--out", "o"},
      process::hangups::ignored);
  // Wait until the program runs: between fork and exec a hangup still kills it.
  await(
      [&] { return fs::exists(folder.path() / "o/.lock") || fs::exists(folder.path() / "o/manifest.json"); });
  await([&] {
    run.send(SIGHUP);
    return fs::exists(folder.path() / "o/manifest.json");
  });
  const outcome result = run.wait();
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_EQ(json::parse(read(folder.path() / "o/manifest.json"))["state"], "complete");
}

TEST(a_case, that_does_not_fit_into_memory_is_refused_with_numbers_before_anything_is_allocated) {
  const work_folder folder;
  // 50000 snapshots of three fields on 10^7 cells are 12 TB.
  const outcome result =
      shell(folder, "$APSIS run paper/bgk-mixed space.cells=10000000 output.every=1e-5 --out o");
  EXPECT_EQ(result.code, 2) << result.err;
  EXPECT_THAT(result.err, AllOf(HasSubstr("needs at least"), HasSubstr("GB are left"),
                                HasSubstr("10000000 cells x 150 unknowns"), HasSubstr("use fewer cells")));
  EXPECT_FALSE(fs::exists(folder.path() / "o"));
}

TEST(a_run, of_very_many_steps_is_announced_as_such_and_its_history_stays_small) {
  const work_folder folder;
  const outcome result =
      shell(folder, "$APSIS run paper/ode time.dt=1e-12 output.history_rows=1000 --wall 0.5 --out o");
  EXPECT_EQ(result.code, 130) << result.err;
  const json manifest = json::parse(read(folder.path() / "o/manifest.json"));
  std::istringstream history(read(folder.path() / "o/history.csv"));
  std::string last;
  long lines = 0;
  for (std::string line; std::getline(history, line); ++lines) last = line;
  EXPECT_LE(lines, 1001);
  EXPECT_EQ(std::stol(last), manifest["result"]["steps"].get<long>());
  // The program prints the estimate after a thousand steps. A machine may not reach them in half a second.
  if (manifest["result"]["steps"].get<long>() >= 1000) {
    EXPECT_THAT(result.err, AllOf(HasSubstr("about 1e+12 steps are left"), HasSubstr(" s a step")));
  }
}

TEST(a_manifest, records_version_command_and_host_of_a_run) {
  const work_folder folder;
  ASSERT_EQ(shell(folder, "$APSIS run paper/ode time.dt=1/16 --out o").code, 0);
  const json m = json::parse(read(folder.path() / "o/manifest.json"));
  EXPECT_THAT(m["commit"].get<std::string>(), testing::MatchesRegex("unknown|[0-9a-f]{40}(-dirty)?"));
  EXPECT_EQ(m["commit"], apsis::commit());
  const auto command = m["command"].get<std::vector<std::string>>();
  EXPECT_EQ(std::vector<std::string>(command.begin() + 1, command.end()),
            (std::vector<std::string>{"run", "paper/ode", "time.dt=1/16", "--out", "o"}));
  char host[256] = {};
  ASSERT_EQ(gethostname(host, sizeof host - 1), 0);
  EXPECT_EQ(m["machine"]["host"], host);
  for (const std::string key : {"started", "written"})
    EXPECT_THAT(m[key].get<std::string>(), testing::MatchesRegex("[0-9]{4}-[0-9]{2}-[0-9]{2}T[0-9:]{8}Z"));
  EXPECT_LE(m["started"].get<std::string>(), m["written"].get<std::string>());
  EXPECT_FALSE(m.contains("restart"));
  ASSERT_EQ(
      shell(folder, "$APSIS run paper/ode time.dt=1/16 time.end=2 --restart o/checkpoint.h5 --out p").code,
      0);
  EXPECT_EQ(json::parse(read(folder.path() / "p/manifest.json"))["restart"], "o/checkpoint.h5");
}

namespace {

/// Names under which a run writes files before they are complete, and the final names of these files.
const std::vector<std::string> written_names = {".lock",
                                                ".probe.partial",
                                                ".history.csv.partial",
                                                ".fields.csv.partial",
                                                ".solution.h5.partial",
                                                ".solution.xdmf.partial",
                                                ".checkpoint.h5.partial",
                                                ".manifest.json.partial",
                                                "history.csv",
                                                "fields.csv",
                                                "solution.h5",
                                                "checkpoint.h5"};

}  // namespace

TEST(a_result_folder, of_others_has_no_link_through_which_a_run_writes) {
  for (const std::string& name : written_names)
    for (const bool hard : {false, true}) {
      const work_folder folder;
      folder.file("mine", "precious");
      fs::create_directory(folder.path() / "o");
      if (hard)
        fs::create_hard_link(folder.path() / "mine", folder.path() / "o" / name);
      else
        fs::create_symlink(folder.path() / "mine", folder.path() / "o" / name);
      const outcome done = shell(folder, "$APSIS run paper/ode --out o");
      EXPECT_EQ(read(folder.path() / "mine"), "precious") << name << hard;
      if (name == ".lock") {
        EXPECT_EQ(done.code, 4) << done.err;
        EXPECT_THAT(done.err, testing::AnyOf(HasSubstr("it is a symbolic link"), HasSubstr("this name too")));
      } else {
        EXPECT_EQ(done.code, 0) << name << done.err;
        EXPECT_FALSE(fs::is_symlink(folder.path() / "o" / name)) << name;
      }
    }
}

TEST(a_result_folder, has_no_link_to_another_folder_for_its_series) {
  const work_folder folder;
  fs::create_directories(folder.path() / "elsewhere");
  folder.file("elsewhere/mine", "precious");
  fs::create_directory(folder.path() / "o");
  const std::string run =
      "$APSIS run paper/bgk-mixed space.cells=12 velocity.points=40 output.every=0.005 "
      "output.distribution=snapshots time.end=0.01 --out o";
  for (const std::string name : {"snapshots", ".snapshots.partial"}) {
    fs::remove_all(folder.path() / "o" / name);
    fs::create_directory_symlink(folder.path() / "elsewhere", folder.path() / "o" / name);
    EXPECT_EQ(shell(folder, run).code, 0) << name << read(folder.path() / "err.txt");
    EXPECT_EQ(std::distance(fs::directory_iterator(folder.path() / "elsewhere"), {}), 1) << name;
  }
  fs::remove_all(folder.path() / "o/snapshots");
  fs::create_directory_symlink(folder.path() / "elsewhere", folder.path() / "o/.snapshots.partial");
  const outcome resumed = shell(folder, run + " time.end=0.02 --restart o/checkpoint.h5");
  EXPECT_EQ(resumed.code, 0) << resumed.err;
  EXPECT_EQ(read(folder.path() / "elsewhere/mine"), "precious");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path() / "elsewhere"), {}), 1);
}

TEST(a_folder, that_was_deleted_during_a_run_is_named_as_the_reason) {
  const work_folder folder;
  process run(folder, into(endless, "o"));
  await([&] { return read(folder.path() / "o/.lock").find('\n') != std::string::npos; });
  fs::remove_all(folder.path() / "o");
  run.send(SIGINT);
  const outcome stopped = run.wait();
  EXPECT_EQ(stopped.code, 4) << stopped.err;
  EXPECT_THAT(stopped.err, HasSubstr("cannot write 'o/.history.csv.partial' (there is no folder 'o', it may "
                                     "have been deleted); choose another folder"));
}

TEST(messages_and_results, do_not_obey_a_case) {
  const work_folder folder;
  const std::string begins =
      "title = \"\\u001b]0;owned\\u0007 \\u009b31m \\u202e\"\n[model]\nname = \"ode\"\nepsilon = 1.0\n";
  folder.file("c.toml", begins + "\"k\\u001bey\" = 1\n");
  folder.file("d.toml", begins + "[time]\nmethod = \"md-imex-6-3\"\nend = 1.0\ndt = 0.125\n");
  const outcome refused = shell(folder, "$APSIS run c.toml");
  EXPECT_EQ(refused.code, 2) << refused.err;
  EXPECT_THAT(refused.err, HasSubstr("k?ey"));
  for (const std::string command : {"run d.toml", "run d.toml --json", "run 'n\x1b[31m'"}) {
    const outcome shown = shell(folder, "$APSIS " + command);
    for (const std::string& text : {refused.err, shown.out, shown.err}) {
      EXPECT_EQ(text.find('\x1b'), std::string::npos) << command;
      EXPECT_EQ(text.find('\a'), std::string::npos) << command;
      EXPECT_EQ(text.find("\xc2\x9b"), std::string::npos) << command;
      EXPECT_EQ(text.find("\xe2\x80\xae"), std::string::npos) << command;
    }
    if (command == "run d.toml") {
      EXPECT_EQ(shown.code, 0) << shown.err;
      EXPECT_THAT(shown.out, HasSubstr("\\u001b]0;owned\\u0007 \\u009b31m \\u202e"));
    }
    if (command == "run d.toml --json") {
      EXPECT_EQ(json::parse(shown.out)["case"]["title"],
                "\x1b]0;owned\a \xc2\x9b"
                "31m \xe2\x80\xae");
    }
  }
}

TEST(safety_of_results, iterations_that_were_not_enough_continue_from_their_checkpoint) {
  const work_folder folder;
  const auto run = [&](const std::string& iterations, std::vector<std::string> more) {
    std::vector<std::string> all = {
        "run", "gas/couette", "space.cells=8", "steady.iterations=" + iterations, "--out", "o"};
    all.insert(all.end(), more.begin(), more.end());
    return run_apsis(folder, all);
  };
  const outcome first = run("5", {});
  EXPECT_EQ(first.code, 3);
  EXPECT_THAT(first.err, HasSubstr("no steady state in 5 iterations"));
  const outcome second = run("100", {"--restart", "o/checkpoint.h5"});
  EXPECT_EQ(second.code, 0) << second.err;
  // The history has every iteration once.
  std::istringstream history(read(folder.path() / "o/history.csv"));
  std::string line;
  std::getline(history, line);
  long step = 0;
  for (; std::getline(history, line); ++step) EXPECT_EQ(std::stol(line), step);
  EXPECT_GT(step, 10);
}

}  // namespace safety_of_results_test
