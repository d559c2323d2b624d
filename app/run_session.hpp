#pragma once

#include "run_options.hpp"
#include "run_report.hpp"

#include <apsis/output/progress.hpp>
#include <apsis/output/result_folder.hpp>

#include <chrono>
#include <memory>

namespace apsis::app {

/// One `apsis run`: the time loop with its records, checkpoints and results.
class run_session {
 public:
  /// Checks everything and prepares the folder. Throws input_error or io_error; then nothing was left behind.
  explicit run_session(run_options options);

  /// Steps to the end, to an interrupt, or until the wall time is over, and writes the results. A
  /// numerical_error passes through after what was computed so far has been saved.
  run_end run();

  const simulation& computed() const { return simulation_; }
  /// Of the finished run: with a snapshot of its end.
  const run_records& records() const { return *shown_; }

 private:
  using clock = std::chrono::steady_clock;
  void resume(const std::string& path);
  void loop();
  void after_step();
  void finish_records();
  void write_results(result_folder& folder, run_end end, const std::string& message);
  void save_failure(const std::string& message);

  run_options options_;
  clock::time_point start_ = clock::now();
  simulation simulation_;
  std::unique_ptr<run_records> records_, shown_;
  std::unique_ptr<result_folder> folder_;
  std::unique_ptr<progress> bar_;
  run_end end_ = run_end::complete;
  long snapshots_ = 0;  ///< multiples of output.every that are behind
};

}  // namespace apsis::app
