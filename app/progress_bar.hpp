#pragma once

#include <chrono>
#include <string>

namespace apsis::app {

/// A bar on standard error during a computation; silent if standard error is not a terminal.
class progress_bar {
 public:
  progress_bar();
  ~progress_bar();
  progress_bar(const progress_bar&) = delete;
  progress_bar& operator=(const progress_bar&) = delete;

  /// Whether update() would draw now: at most ten times a second, and never without a terminal.
  bool due() const;
  /// Draws the bar at `fraction` in [0, 1], followed by the remaining time and `text`, if due(). The line
  /// is truncated to the terminal width. The remaining time is extrapolated from the time since the bar
  /// was created.
  void update(double fraction, const std::string& text);
  /// Erases the bar, so that messages start on a fresh line.
  void finish();

 private:
  using clock = std::chrono::steady_clock;
  bool visible_, drawn_ = false;
  clock::time_point start_, last_;
  double first_ = -1.0;
};

}  // namespace apsis::app
