#include "drawing.hpp"
#include "interrupt.hpp"

#include <apsis/core/embedded.hpp>
#include <apsis/core/errors.hpp>
#include <apsis/core/text_file.hpp>

#include <cerrno>
#include <csignal>
#include <cstdlib>

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

namespace apsis::embedded {
/// Returns every module of python/apsis, with which the program draws (generated).
std::vector<embedded_text> scripts();
}  // namespace apsis::embedded

namespace apsis::app {
namespace {

namespace fs = std::filesystem;

/// The output of a child process that is suppressed.
enum class dropped { nothing, output, everything };

/// Waits for a child process and returns its termination status. Meanwhile forwards interrupts to it.
int status_of(pid_t child) {
  {
    const forwarded_interrupts forwarding(child);
    // WNOWAIT keeps the process id valid while a handler may send it a signal.
    siginfo_t end = {};
    while (waitid(P_PID, static_cast<id_t>(child), &end, WEXITED | WNOWAIT) < 0)
      if (errno != EINTR) break;
  }
  int status = -1;
  while (waitpid(child, &status, 0) < 0)
    if (errno != EINTR) break;
  return status;
}

/// Runs a program and returns its exit status; −1 if it cannot run. If a signal arrives, throws interruption
/// after the program has ended.
int execute(const std::vector<std::string>& words, dropped drop) {
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
  for (const auto& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  if (drop != dropped::nothing)
    posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  if (drop == dropped::everything)
    posix_spawn_file_actions_addopen(&files, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  // A separate process group, so that a terminal sends Ctrl-C only to this program, which forwards it.
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  posix_spawnattr_setpgroup(&attributes, 0);
  pid_t child = 0;
  const int failed = posix_spawnp(&child, arguments[0], &files, &attributes, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&files);
  posix_spawnattr_destroy(&attributes);
  if (failed != 0) return -1;
  const int status = status_of(child);
  if (interrupted()) throw interruption();
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

std::string find_python() {
  std::vector<std::string> candidates = {"/usr/bin/python3", "python3"};
  if (const char* wanted = std::getenv("APSIS_PYTHON")) candidates = {wanted};
  for (const auto& candidate : candidates)
    if (execute({candidate, "-c", "import matplotlib, numpy, h5py"}, dropped::everything) == 0)
      return candidate;
  throw io_error(
      fmt::format("pictures cannot be drawn (no Python with matplotlib and h5py among: {}); install "
                  "python3-matplotlib and python3-h5py, or name a Python in APSIS_PYTHON",
                  fmt::join(candidates, ", ")));
}

fs::path new_folder() {
  std::string pattern = (fs::temp_directory_path() / "apsis-XXXXXX").string();
  if (mkdtemp(pattern.data()) == nullptr)
    throw io_error(fmt::format("cannot make a folder in '{}' (it is full or not writable); set TMPDIR",
                               fs::temp_directory_path().string()));
  return pattern;
}

}  // namespace

drawing::temporary_folder::temporary_folder() : path_(new_folder()) {}

drawing::temporary_folder::~temporary_folder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

drawing::drawing() : python_(find_python()) {
  add("apsis/__init__.py", "");
  // Only subpackages are copied, because they need no compiled module; the other modules belong to the
  // Python package.
  for (const auto& script : embedded::scripts())
    if (script.name.find('/') != std::string_view::npos)
      add(fmt::format("apsis/{}.py", script.name), std::string(script.text));
}

std::string drawing::add(const std::string& name, const std::string& text) const {
  const fs::path path = folder_.path() / name;
  std::error_code problem;
  fs::create_directories(path.parent_path(), problem);
  write_text_file(path.string(), text, "set TMPDIR to a folder with space");
  return path.string();
}

int drawing::run(const std::string& module, const std::vector<std::string>& arguments, bool quiet) const {
  // The script lies next to the package, so that it finds the package from any working directory.
  const std::string script = add(
      module + ".py", fmt::format("from apsis.{}.__main__ import main\nraise SystemExit(main())\n", module));
  std::vector<std::string> words = {python_, "-B", script};
  words.insert(words.end(), arguments.begin(), arguments.end());
  return execute(words, quiet ? dropped::output : dropped::nothing);
}

void draw(const std::string& module, const std::vector<std::string>& arguments) {
  const int status = drawing().run(module, arguments, true);
  if (status != 0)
    throw io_error(
        fmt::format("drawing failed (exit status {} of apsis.{}); see the message above; the data are saved",
                    status, module));
}

}  // namespace apsis::app
