#include "terminal.hpp"

#include <cerrno>
#include <cstdlib>
#include <stdexcept>

#include <fcntl.h>
#include <sys/ioctl.h>
#include <sys/wait.h>
#include <termios.h>
#include <unistd.h>

namespace app_test {
namespace {

/// Both ends of a pseudo-terminal in raw mode.
struct pseudo_terminal {
  explicit pseudo_terminal(unsigned short columns) : reader(posix_openpt(O_RDWR | O_NOCTTY)) {
    if (reader < 0 || grantpt(reader) != 0 || unlockpt(reader) != 0)
      throw std::runtime_error("no pseudo-terminal");
    writer = open(ptsname(reader), O_RDWR | O_NOCTTY);
    termios settings = {};
    if (writer < 0 || tcgetattr(writer, &settings) != 0) throw std::runtime_error("no pseudo-terminal");
    cfmakeraw(&settings);
    tcsetattr(writer, TCSANOW, &settings);
    winsize size = {};
    size.ws_col = columns;
    ioctl(writer, TIOCSWINSZ, &size);
  }
  int reader, writer = -1;
};

/// Reads until the last process that can write has ended.
std::string read_all(int descriptor) {
  std::string text;
  char part[4096];
  for (;;) {
    const ssize_t count = ::read(descriptor, part, sizeof part);
    if (count > 0)
      text.append(part, static_cast<std::size_t>(count));
    else if (count == 0 || errno != EINTR)
      return text;
  }
}

}  // namespace

outcome run_on_terminal(const work_folder& folder, const std::vector<std::string>& arguments,
                        unsigned short columns) {
  const work_folder capture;
  const std::string file = (capture.path() / "out").string();
  const pseudo_terminal terminal(columns);
  std::vector<char*> argv = {const_cast<char*>("apsis")};
  for (const auto& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  const pid_t id = fork();
  if (id == 0) {
    dup2(open(file.c_str(), O_CREAT | O_WRONLY, 0600), STDOUT_FILENO);
    dup2(terminal.writer, STDERR_FILENO);
    close(terminal.writer);
    close(terminal.reader);
    if (chdir(folder.path().c_str()) == 0) execv(APSIS_PROGRAM, argv.data());
    _exit(127);
  }
  close(terminal.writer);
  outcome result;
  result.err = read_all(terminal.reader);
  close(terminal.reader);
  int status = 0;
  waitpid(id, &status, 0);
  result.code = WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status);
  result.out = read(file);
  return result;
}

}  // namespace app_test
