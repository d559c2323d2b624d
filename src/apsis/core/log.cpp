#include <apsis/core/log.hpp>

#include <apsis/core/printable.hpp>
#include <apsis/core/warning_record.hpp>
#include <apsis/core/warnings_once.hpp>

#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <string_view>

#include <unistd.h>

namespace apsis::log {
namespace {

std::atomic<level> lowest_shown{level::info};
std::atomic<warning_receiver> receiver_of_warnings{nullptr};

/// Returns true if standard error is a terminal that supports colours.
bool supports_colour() {
  static const bool answer = [] {
    const char* terminal = std::getenv("TERM");
    return isatty(STDERR_FILENO) == 1 && terminal != nullptr && std::string_view(terminal) != "dumb";
  }();
  return answer;
}

/// Writes a line with one fwrite call, so that lines of several threads do not interleave.
void write(std::string_view name, std::string_view colour, const std::string& message) {
  std::string line(name);
  // A progress bar may occupy the line.
  if (supports_colour()) line = "\r\033[K" + std::string(colour) + line + "\033[m";
  line += ": " + printable(message) + "\n";
  std::fwrite(line.data(), 1, line.size(), stderr);
}

}  // namespace

level set_level(level lowest) {
  return lowest_shown.exchange(lowest);
}

warning_receiver set_warning_receiver(warning_receiver receiver) {
  return receiver_of_warnings.exchange(receiver);
}

void info(const std::string& message) {
  if (lowest_shown >= level::info) write("info", "\033[32m", message);
}

void warning(const std::string& message) {
  if (!warnings_once::is_new(message)) return;
  warning_record::add_to_all(message);
  if (lowest_shown < level::warning) return;
  if (const warning_receiver receiver = receiver_of_warnings)
    receiver(message);
  else
    write("warning", "\033[33m\033[1m", message);
}

}  // namespace apsis::log
