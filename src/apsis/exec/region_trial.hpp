#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

namespace apsis {

/// Finds out whether short parallel regions are faster on several threads or on the caller alone. On small
/// meshes, rows that move between cores cost more than the other threads save, which no time within a region
/// shows: the caller's own jobs become slower, too. So the way that is not in use is tried between two
/// windows of the other, each of several time steps, and kept if it is faster. The time between two trials
/// doubles as long as their outcome does not change. Regions longer than `longest` always run on all threads.
class region_trial {
 public:
  static constexpr long window = 128;      ///< number of regions that are compared
  static constexpr long warm_up = 16;      ///< regions before each window, in which data move between caches
  static constexpr double longest = 3e-4;  ///< in seconds
  static constexpr long shortest_hold = 16;   ///< smallest number of windows between two trials
  static constexpr long longest_hold = 1024;  ///< largest number of windows between two trials

  /// Whether the next region is to run on the caller alone.
  bool alone() const { return (phase_ == phase::other) != kept_alone_; }

  /// Records the duration in seconds of a region that ran as alone() said.
  void add(double seconds) {
    if (seconds > longest) {
      kept_alone_ = false;
      hold_ = longest_hold;
      begin(phase::hold);
      return;
    }
    ++regions_;
    if (phase_ == phase::hold) {
      if (regions_ >= hold_ * window) begin(phase::before);
      return;
    }
    if (regions_ > warm_up) seconds_[static_cast<std::size_t>(phase_)] += seconds;
    if (regions_ == warm_up + window) finish_window();
  }

 private:
  enum class phase { before, other, after, hold };

  void begin(phase next) {
    phase_ = next;
    regions_ = 0;
    if (next == phase::before) seconds_ = {};
  }

  void finish_window() {
    if (phase_ == phase::before) return begin(phase::other);
    if (phase_ == phase::other) return begin(phase::after);
    const auto& [before, other, after] = seconds_;
    const bool is_faster = 2.0 * other < before + after;
    hold_ = is_faster ? shortest_hold : std::min(2 * hold_, longest_hold);
    if (is_faster) kept_alone_ = !kept_alone_;
    begin(phase::hold);
  }

  phase phase_ = phase::before;
  bool kept_alone_ = false;
  long regions_ = 0, hold_ = shortest_hold / 2;
  std::array<double, 3> seconds_{};  ///< of the windows of a trial
};

}  // namespace apsis
