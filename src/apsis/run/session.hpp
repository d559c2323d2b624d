#pragma once

#include <apsis/core/warning_record.hpp>
#include <apsis/device/device.hpp>
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

/// Returns the default number of threads of each process for a case. It is OMP_NUM_THREADS if set. Otherwise
/// a process with at least 32768 unknowns takes its share of the processors of this machine. With fewer
/// unknowns, which gain little from threads, it is 1.
int threads_for(const case_config& config, const communicator& processes = *single_process());

/// Session options: output, restart, limits, callbacks.
struct session_options {
  std::shared_ptr<communicator> processes = single_process();  ///< share the mesh; all need the same options
  std::shared_ptr<device> on;                                  ///< a device for the run; null: the host
  std::optional<std::string> out;      ///< result folder; without it nothing is written
  std::optional<std::string> restart;  ///< checkpoint of the same case to continue from
  std::optional<double> wall;          ///< wall time in seconds after which to stop with a checkpoint
  std::vector<std::string> command;    ///< command line for the manifest; empty if unknown
  std::function<bool()> stop;          ///< called before every step; true stops with a checkpoint
  /// Called after every step, and once before the first.
  std::function<void(const simulation&)> watch;
  state_source initial;           ///< initial state in place of that of the case; not used by a restart
  std::function<void()> stepped;  ///< called once after the last step, before reporting
};

/// A run of a case with its records, checkpoints and results.
class run_session {
 public:
  /// Checks the case and prepares the folder. Throws input_error or io_error without leaving files behind.
  run_session(const case_config& config, session_options options);

  /// Runs to the end, to a stop, or to the wall-time limit, and writes the results. Rethrows a
  /// numerical_error after saving the results so far.
  run_end run();

  /// Returns the run in its current state.
  const simulation& computed() const { return simulation_; }
  /// Returns the records of the finished run, including a snapshot of the final state.
  const run_records& records() const { return *shown_; }
  /// Returns the warnings since the construction.
  std::vector<std::string> warnings() const { return warnings_.messages(); }

 private:
  using clock = std::chrono::steady_clock;
  void resume(const std::string& path);
  void loop();
  void after_step();
  bool checkpoint_is_due() const;
  void publish_checkpoint();
  run_end end_requested() const;
  communicator& processes() const { return *options_.processes; }
  /// Returns whether results are written. Only the root has the folder itself.
  bool has_folder() const { return options_.out.has_value(); }
  void warn_of_many_steps();
  void take_snapshot();
  void write_distribution_snapshot();
  void resume_snapshots(const std::string& checkpoint);
  void finish_records();
  void report_steady_state() const;
  std::string promise_of_steady_state() const;
  void write_results(result_folder* folder, run_end end, const std::string& message);
  void write_tables(result_folder& folder, const solution& final_state,
                    const std::vector<surface_table>& walls);
  void save_failure(const std::string& message);

  warning_record warnings_;  ///< records warnings of the members below, too
  session_options options_;
  clock::time_point start_ = clock::now(), last_checkpoint_ = start_;
  std::string started_ = time_stamp();
  simulation simulation_;
  std::unique_ptr<run_records> records_, shown_;
  std::unique_ptr<result_folder> folder_;
  /// State before the first step whose length depends on time.end; a continuation to a later end starts here.
  std::optional<checkpoint> before_end_;
  long warn_at_step_ = -1;  ///< step at which the duration of the run is estimated; −1: never
  run_end end_ = run_end::complete;
  long snapshots_ = 0;  ///< multiples of output.every passed
};

}  // namespace apsis
