#include "progress_bar.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

namespace apsis::app {

namespace {

constexpr const char* erase_line = "\r\033[K";

/// Writes to standard error. Ignores errors of a closed terminal, which must not end a run.
void say(const std::string& text) {
  std::fputs(text.c_str(), stderr);
  std::fflush(stderr);
}

/// Returns "[=====>    ]  42 %".
std::string bar(double fraction) {
  constexpr int width = 24;
  const auto full = static_cast<std::size_t>(fraction * width);
  std::string text(width, ' ');
  std::fill_n(text.begin(), full, '=');
  if (full < width) text[full] = '>';
  return fmt::format("[{}] {:3.0f} %", text, 100.0 * fraction);
}

/// Returns "12:34:56" or "0:05"; "--" if unknown.
std::string time_left(double seconds) {
  if (!std::isfinite(seconds) || seconds >= 3.6e6) return "--";
  const long s = std::lround(seconds);
  return s >= 3600 ? fmt::format("{}:{:02}:{:02}", s / 3600, s / 60 % 60, s % 60)
                   : fmt::format("{}:{:02}", s / 60, s % 60);
}

/// Returns the line truncated to the terminal width, because a wrapped line could not be erased.
std::string fitted(const std::string& line) {
  winsize size = {};
  if (ioctl(STDERR_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col < 2) return line;
  return fmt::format("{:.{}}", line, size.ws_col - 1);
}

}  // namespace

progress_bar::progress_bar() : visible_(isatty(STDERR_FILENO) == 1), start_(clock::now()), last_(start_) {}

progress_bar::~progress_bar() {
  finish();
}

bool progress_bar::due() const {
  return visible_ && (!drawn_ || clock::now() - last_ >= std::chrono::milliseconds(100));
}

void progress_bar::update(double fraction, const std::string& text) {
  if (!due()) return;
  last_ = clock::now();
  const double part = std::clamp(fraction, 0.0, 1.0);
  if (first_ < 0.0) first_ = part;
  const double elapsed = std::chrono::duration<double>(last_ - start_).count();
  const double left = part > first_ ? elapsed * (1.0 - part) / (part - first_) : HUGE_VAL;
  say(erase_line + fitted(fmt::format("{}  {} left  {}", bar(part), time_left(left), text)));
  drawn_ = true;
}

void progress_bar::finish() {
  if (drawn_) say(erase_line);
  drawn_ = false;
}

}  // namespace apsis::app
