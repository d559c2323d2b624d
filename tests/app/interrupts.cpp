// A command reacts to a signal within a step. No test depends on time: the signal is sent after a line was
// printed or a file was opened, during work that would last for hours or minutes.
#include "program.hpp"

#include <csignal>
#include <cstdlib>

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/stat.h>
#include <unistd.h>

namespace interrupts_test {

using namespace app_test;
using nlohmann::json;
using testing::HasSubstr;

namespace {

namespace fs = std::filesystem;

/// Sets an environment variable during its lifetime.
class variable {
 public:
  variable(const char* name, const std::string& value) : name_(name) {
    if (const char* before = std::getenv(name)) before_ = before, had_ = true;
    setenv(name, value.c_str(), 1);
  }
  ~variable() { had_ ? setenv(name_, before_.c_str(), 1) : unsetenv(name_); }
  variable(const variable&) = delete;
  variable& operator=(const variable&) = delete;

 private:
  const char* name_;
  std::string before_;
  bool had_ = false;
};

class every_signal : public testing::TestWithParam<int> {};

TEST_P(every_signal, ends_converge_within_a_step_and_states_what_it_waits_for) {
  const work_folder folder;
  // Ten thousand million steps take hours.
  process run(folder,
              {"converge", "paper/ode", "--vary", "time.dt=1e-10,1e-11", "--threads", "1", "--out", "o"});
  ASSERT_TRUE(run.wait_for("3 runs; "));
  run.send(GetParam());
  const outcome stopped = run.wait();
  EXPECT_EQ(stopped.code, 130) << stopped.err;
  EXPECT_THAT(stopped.err, HasSubstr("interrupted: waiting for the current step of every run"));
  EXPECT_THAT(stopped.err, HasSubstr("interrupted (0 of 3 runs are finished); apsis plot o draws them"));
  EXPECT_EQ(json::parse(read(folder.path() / "o/manifest.json"))["state"], "interrupted");
  EXPECT_TRUE(json::parse(read(folder.path() / "o/converge.json")).empty());
}

TEST_P(every_signal, ends_a_run_before_its_first_step_and_leaves_nothing_behind) {
  const work_folder folder;
  // The sampling of three formulas in 1.5 million cells lasts until the signal arrives.
  folder.file("c.toml",
              "[model]\nname = \"bgk\"\nepsilon = 0.1\n[velocity]\nmax = 8\npoints = 16\n[space]\ncells = "
              "1500000\ndomain = [0, 1]\n[time]\nmethod = \"md-imex-6-3\"\nend = 1.0\ndt = "
              "1e-9\n[initial]\nrho = \"1 + 0.1*sin(x)\"\n"
              "u = \"sin(x)/10\"\nT = \"1 + exp(-x)/10\"\n");
  process run(folder, {"run", "c.toml", "--threads", "1", "--out", "o"});
  ASSERT_TRUE(run.wait_for("needs ")) << run.said();
  run.send(GetParam());
  const outcome stopped = run.wait();
  EXPECT_EQ(stopped.code, 130) << stopped.err;
  EXPECT_THAT(stopped.err, HasSubstr("error: interrupted before the first step (there is nothing to save)"));
  EXPECT_FALSE(fs::exists(folder.path() / "o"));
}

TEST_P(every_signal, ends_commands_that_have_nothing_to_save) {
  using words = std::vector<std::string>;
  std::vector<words> commands = {{"check", "m.toml", "--observe"}};
  if (APSIS_HAS_DESIGN) commands.push_back({"design", "--embedded", "m.toml", "--out", "o.toml"});
  for (const words& command : commands) {
    const work_folder folder;
    const std::string pipe = (folder.path() / "m.toml").string();
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    process run(folder, command);
    const int writer = open(pipe.c_str(), O_WRONLY);  // waits until the command has opened it
    ASSERT_GE(writer, 0);
    run.send(GetParam());
    const outcome stopped = run.wait();
    close(writer);
    EXPECT_EQ(stopped.code, 130) << command[0] << stopped.err;
    EXPECT_THAT(stopped.err, HasSubstr("interrupted"));
    EXPECT_FALSE(fs::exists(folder.path() / "o.toml"));
  }
}

TEST_P(every_signal, ends_the_drawing_of_plot_and_report_and_leaves_nothing_behind) {
  const work_folder folder, temporary;
  // This script replaces Python. It succeeds in the test for its modules, then runs without end.
  folder.file("python",
              "#!/bin/sh\ncase \"$1\" in -c) exit 0;; esac\necho $$ > child; echo drawing >&2\n"
              "exec tail -f /dev/null\n");
  fs::permissions(folder.path() / "python", fs::perms::owner_all);
  const variable python("APSIS_PYTHON", (folder.path() / "python").string());
  const variable place("TMPDIR", temporary.path().string());
  for (const char* command : {"plot", "report"}) {
    process run(folder, {command, "imdrk-1-2"});
    ASSERT_TRUE(run.wait_for("drawing"));
    run.send(GetParam());
    const outcome stopped = run.wait();
    EXPECT_EQ(stopped.code, 130) << command << stopped.err;
    EXPECT_THAT(stopped.err, HasSubstr("interrupted: waiting for the "));
    EXPECT_EQ(kill(std::stoi(read(folder.path() / "child")), 0), -1) << "the child lives on";
    for (const auto& entry : fs::directory_iterator(temporary.path()))
      EXPECT_NE(entry.path().filename().string().rfind("apsis-", 0), 0U) << entry.path();
  }
}

}  // namespace

INSTANTIATE_TEST_SUITE_P(signals, every_signal, testing::Values(SIGINT, SIGTERM, SIGHUP), [](const auto& s) {
  return s.param == SIGINT ? "SIGINT" : s.param == SIGTERM ? "SIGTERM" : "SIGHUP";
});

}  // namespace interrupts_test
