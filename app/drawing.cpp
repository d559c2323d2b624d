#include "drawing.hpp"

#include <apsis/core/embedded.hpp>
#include <apsis/core/errors.hpp>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

namespace apsis::app {
namespace {

namespace fs = std::filesystem;

/// Exit status of a program, its standard output sent to our standard error (or nowhere); −1 if it cannot
/// run.
int execute(const std::vector<std::string>& words, bool quiet) {
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
  for (const auto& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  if (quiet) posix_spawn_file_actions_addopen(&files, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  pid_t child = 0;
  const int failed = posix_spawnp(&child, arguments[0], &files, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&files);
  if (failed != 0) return -1;
  int status = 0;
  while (waitpid(child, &status, 0) < 0)
    if (errno != EINTR) return -1;
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

std::string find_python() {
  std::vector<std::string> candidates = {"/usr/bin/python3", "python3"};
  if (const char* wanted = std::getenv("APSIS_PYTHON")) candidates = {wanted};
  for (const auto& candidate : candidates)
    if (execute({candidate, "-c", "import matplotlib, numpy"}, true) == 0) return candidate;
  throw io_error(
      fmt::format("pictures cannot be drawn (no Python with matplotlib among: {}) install "
                  "python3-matplotlib, or name a Python in APSIS_PYTHON",
                  fmt::join(candidates, ", ")));
}

/// The scripts as files, as long as this object lives.
class script_folder {
 public:
  script_folder() {
    std::string pattern = (fs::temp_directory_path() / "apsis-XXXXXX").string();
    if (mkdtemp(pattern.data()) == nullptr)
      throw io_error(fmt::format("cannot make a folder in '{}' (it is full or not writable) set TMPDIR",
                                 fs::temp_directory_path().string()));
    path_ = pattern;
    for (const auto& script : embedded::scripts())
      std::ofstream(path_ / (std::string(script.name) + ".py"), std::ios::binary) << script.text;
  }
  ~script_folder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  script_folder(const script_folder&) = delete;
  script_folder& operator=(const script_folder&) = delete;
  std::string file(const std::string& script) const { return (path_ / (script + ".py")).string(); }

 private:
  fs::path path_;
};

}  // namespace

void draw(const std::string& script, const std::vector<std::string>& arguments) {
  const std::string python = find_python();
  const script_folder scripts;
  std::vector<std::string> words = {python, "-B", scripts.file(script)};
  words.insert(words.end(), arguments.begin(), arguments.end());
  const int status = execute(words, false);
  if (status != 0)
    throw io_error(fmt::format(
        "drawing failed (exit status {} of {}) see the message above; the data are saved", status, script));
}

}  // namespace apsis::app
