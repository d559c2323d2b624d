#pragma once

#include <chrono>
#include <string>

namespace apsis {

/// A bar on standard error while a run goes on; silent where standard error is not a terminal.
class progress {
 public:
  /// For a run from t = 0 to `end`.
  explicit progress(double end);
  ~progress();
  progress(const progress&) = delete;
  progress& operator=(const progress&) = delete;

  /// Whether update() would draw now: at most ten times a second, and never without a terminal.
  bool due() const;
  /// Draws the bar if it is due(). The time left is estimated from that since the bar was made.
  void update(long step, long steps_total, double t, double min_value);
  /// Ends the line, so that messages start on a fresh one.
  void finish();

 private:
  using clock = std::chrono::steady_clock;
  double end_;
  bool visible_, drawn_ = false;
  clock::time_point start_, last_;
  double first_t_ = -1.0;
};

/// The same for a study: how much of it is done, and what is being done.
class task_progress {
 public:
  task_progress();
  ~task_progress();
  task_progress(const task_progress&) = delete;
  task_progress& operator=(const task_progress&) = delete;
  /// Draws a bar at `fraction` in [0, 1] with `what` behind it, at most ten times a second.
  void update(double fraction, const std::string& what);
  /// Ends the line, so that messages start on a fresh one.
  void finish();

 private:
  using clock = std::chrono::steady_clock;
  bool visible_, drawn_ = false;
  clock::time_point start_, last_;
};

/// "[=====>    ]  42 %  step 1234/2900  t = 0.21  min 1.2e-31  0:12 left"
std::string progress_line(double fraction, long step, long steps_total, double t, double min_value,
                          double seconds_left);

}  // namespace apsis
