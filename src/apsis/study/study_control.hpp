#pragma once

#include <functional>
#include <string>

namespace apsis {

/// Callbacks of a study: progress and stop requests.
struct study_control {
  /// Called with the completed fraction of the current study in [0, 1] and a description; may be empty.
  std::function<void(double, const std::string&)> progress;
  /// Called between runs, and between the steps of a run; true ends the study with study_interrupted. May
  /// be empty.
  std::function<bool()> stop;

  /// Calls `progress` if there is one.
  void report(double fraction, const std::string& what) const;
  /// Throws study_interrupted if `stop` returns true.
  void check() const;
};

/// Thrown when a study was asked to stop.
struct study_interrupted {};

/// Runs body(k), k = 0 … count−1, on all threads (see set_threads) in the order of k, each run on one thread.
/// Reports progress and stops between runs.
void run_all(const study_control& control, const std::string& what, int count,
             const std::function<void(int)>& body);

}  // namespace apsis
