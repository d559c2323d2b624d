#include "program.hpp"

#include <algorithm>
#include <csignal>
#include <ctime>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace app_test {
namespace fs = std::filesystem;

namespace {
fs::path fresh_folder(const std::string& stem) {
  std::string name = (fs::temp_directory_path() / (stem + "-XXXXXX")).string();
  if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
  return name;
}
}  // namespace

work_folder::work_folder() : path_(fresh_folder("apsis-test")) {}

work_folder::~work_folder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

std::string work_folder::file(const std::string& name, const std::string& text) const {
  std::ofstream(path_ / name, std::ios::binary) << text;
  return name;
}

std::vector<std::string> work_folder::listing() const {
  std::vector<std::string> all;
  for (const auto& entry : fs::recursive_directory_iterator(path_))
    all.push_back(entry.path().string() +
                  (entry.is_regular_file() ? " " + std::to_string(entry.file_size()) : "/"));
  std::sort(all.begin(), all.end());
  return all;
}

process::process(const work_folder& folder, const std::vector<std::string>& arguments, hangups hangup)
    : capture_(fresh_folder("apsis-capture")), id_(fork()) {
  if (id_ != 0) return;
  std::signal(
      SIGHUP,
      hangup == hangups::ignored ? SIG_IGN : SIG_DFL);  // the parent process of the tests may ignore it
  const int out = open((capture_ / "out").c_str(), O_CREAT | O_WRONLY, 0600);
  const int err = open((capture_ / "err").c_str(), O_CREAT | O_WRONLY, 0600);
  dup2(out, STDOUT_FILENO);
  dup2(err, STDERR_FILENO);
  std::vector<char*> argv = {const_cast<char*>("apsis")};
  for (const auto& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  if (chdir(folder.path().c_str()) == 0) execv(APSIS_PROGRAM, argv.data());
  _exit(127);
}

void process::send(int signal) const {
  kill(id_, signal);
}

bool process::wait_until(const std::function<bool()>& seen) const {
  const auto ended = [this] {
    siginfo_t info{};
    return waitid(P_PID, static_cast<id_t>(id_), &info, WEXITED | WNOHANG | WNOWAIT) == 0 && info.si_pid != 0;
  };
  while (!seen()) {
    if (ended()) return seen();
    usleep(2000);  // polling interval; no result depends on its length
  }
  return true;
}

std::string process::said() const {
  return read(capture_ / "err");
}

bool process::wait_for(const std::string& text) const {
  return wait_until([&] { return said().find(text) != std::string::npos; });
}

outcome process::wait() {
  int status = 0;
  waitpid(id_, &status, 0);
  outcome result;
  result.code = WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status);
  result.out = read(capture_ / "out");
  result.err = read(capture_ / "err");
  std::error_code ignored;
  fs::remove_all(capture_, ignored);
  return result;
}

outcome run_apsis(const work_folder& folder, const std::vector<std::string>& arguments) {
  return process(folder, arguments).wait();
}

std::string read(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace app_test
