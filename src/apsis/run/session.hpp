#pragma once

#include <apsis/output/provenance.hpp>
#include <apsis/output/result_folder.hpp>
#include <apsis/run/manifest.hpp>

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace apsis {

/// Threads for a case whose user gives no number: what OMP_NUM_THREADS asks for; without it all processors
/// for 32768 unknowns and more, and 1 for fewer, which gain little by it.
int threads_for(const case_config& config);

/// What goes on around a run.
struct session_options {
  std::optional<std::string> out;      ///< folder of the results; without it nothing is written
  std::optional<std::string> restart;  ///< checkpoint of the same case to go on from
  std::optional<double> wall;          ///< seconds after which to stop as if interrupted
  std::vector<std::string> command;    ///< command line, for the manifest; empty where there is none
  std::function<bool()> stop;          ///< asked before every step: whether to stop with a checkpoint
  /// Called after every step, and once before the first.
  std::function<void(const simulation&)> watch;
  std::function<void()> stepped;  ///< called when no more steps come, before anything is said or written
};

/// A run of a case with its records, checkpoints and results.
class run_session {
 public:
  /// Checks everything and prepares the folder. Throws input_error or io_error; then nothing was left behind.
  run_session(case_config config, session_options options);

  /// Steps to the end, to a stop, or until the wall time is over, and writes the results. A numerical_error
  /// passes through after what was computed so far has been saved.
  run_end run();

  /// The run as far as it has come.
  const simulation& computed() const { return simulation_; }
  /// Of the finished run: with a snapshot of its end.
  const run_records& records() const { return *shown_; }

 private:
  using clock = std::chrono::steady_clock;
  void resume(const std::string& path);
  void loop();
  void after_step();
  bool checkpoint_is_due() const;
  void publish_checkpoint();
  void write_checkpoint_of_end(const std::string& path);
  void warn_of_many_steps();
  void take_snapshot();
  void write_distribution_snapshot();
  void resume_snapshots(const std::string& checkpoint);
  void finish_records();
  void write_results(result_folder& folder, run_end end, const std::string& message);
  void save_failure(const std::string& message);

  session_options options_;
  clock::time_point start_ = clock::now(), last_checkpoint_ = start_;
  std::string started_ = time_stamp();
  simulation simulation_;
  std::unique_ptr<run_records> records_, shown_;
  std::unique_ptr<result_folder> folder_;
  /// State before the first step whose length depends on time.end; a continuation to a later end starts here.
  std::optional<checkpoint> before_end_;
  long warn_at_step_ = -1;  ///< after how many steps to say how long all will take
  run_end end_ = run_end::complete;
  long snapshots_ = 0;  ///< multiples of output.every that are behind
};

}  // namespace apsis
