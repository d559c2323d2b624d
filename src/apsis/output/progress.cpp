#include <apsis/output/progress.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <fmt/format.h>
#include <unistd.h>

namespace apsis {

namespace {

/// A terminal that was closed takes nothing; that must not end a run.
void say(const std::string& text) {
  std::fputs(text.c_str(), stderr);
  std::fflush(stderr);
}

/// "[=====>    ]  42 %"
std::string bar(double part) {
  constexpr int width = 24;
  const auto full = static_cast<std::size_t>(part * width);
  std::string text(width, ' ');
  std::fill_n(text.begin(), full, '=');
  if (full < width) text[full] = '>';
  return fmt::format("[{}] {:3.0f} %", text, 100.0 * part);
}

std::string time_left(double seconds) {
  if (!std::isfinite(seconds) || seconds >= 3.6e6) return "--";
  const long s = std::lround(seconds);
  return s >= 3600 ? fmt::format("{}:{:02}:{:02}", s / 3600, s / 60 % 60, s % 60)
                   : fmt::format("{}:{:02}", s / 60, s % 60);
}

}  // namespace

std::string progress_line(double fraction, long step, long steps_total, double t, double min_value,
                          double seconds_left) {
  return fmt::format("{}  step {}/{}  t = {:.4g}  min {:.2e}  {} left", bar(std::clamp(fraction, 0.0, 1.0)),
                     step, steps_total, t, min_value, time_left(seconds_left));
}

progress::progress(double end)
    : end_(end), visible_(isatty(STDERR_FILENO) == 1), start_(clock::now()), last_(start_) {}

progress::~progress() {
  finish();
}

bool progress::due() const {
  return visible_ && (!drawn_ || clock::now() - last_ >= std::chrono::milliseconds(100));
}

void progress::update(long step, long steps_total, double t, double min_value) {
  if (!due()) return;
  const auto now = clock::now();
  if (first_t_ < 0.0) first_t_ = t;
  const double elapsed = std::chrono::duration<double>(now - start_).count();
  const double left = t > first_t_ ? elapsed * (end_ - t) / (t - first_t_) : HUGE_VAL;
  say(fmt::format("\r\033[K{}", progress_line(t / end_, step, steps_total, t, min_value, left)));
  last_ = now;
  drawn_ = true;
}

task_progress::task_progress() : visible_(isatty(STDERR_FILENO) == 1), start_(clock::now()), last_(start_) {}

task_progress::~task_progress() {
  finish();
}

void task_progress::update(double fraction, const std::string& what) {
  const auto now = clock::now();
  if (!visible_ || (drawn_ && now - last_ < std::chrono::milliseconds(100))) return;
  const double part = std::clamp(fraction, 0.0, 1.0);
  say(fmt::format("\r\033[K{}  {:.60}", bar(part), what));
  last_ = now;
  drawn_ = true;
}

void task_progress::finish() {
  if (drawn_) say(fmt::format("\r\033[K"));
  drawn_ = false;
}

void progress::finish() {
  if (drawn_) say(fmt::format("\r\033[K"));
  drawn_ = false;
}

}  // namespace apsis
