#pragma once

#include <apsis/run/records.hpp>
#include <apsis/run/steady_estimate.hpp>

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace apsis {

/// How a run ended.
enum class run_end {
  complete,     ///< at time.end
  interrupted,  ///< stopped with a checkpoint by session_options::stop
  wall_time,    ///< stopped with a checkpoint by session_options::wall
  failed        ///< numerical failure or broken promise
};

/// Returns the name in the manifest: "complete", "interrupted", "wall time reached" or "failed".
std::string to_string(run_end end);

/// Returns the object that `apsis run --json` prints, with the warnings of the run.
nlohmann::ordered_json to_json(const simulation& run, const run_records& records,
                               const std::vector<std::string>& warnings = {});

/// Session data of a manifest.
struct session_record {
  run_end end = run_end::complete;         ///< how the run ended
  std::string message;                     ///< error of a failed run
  std::string started;                     ///< time_stamp() at the start
  std::vector<std::string> command;        ///< command line; empty if unknown
  std::optional<std::string> restart;      ///< checkpoint of a restart, as given
  steady_estimate steady = {};             ///< estimate of a run with time.steady
  std::vector<std::string> warnings = {};  ///< warnings so far
};

/// Returns the content of manifest.json: resolved case, version, commit, command line, times, totals, scales
/// and units, build and machine.
nlohmann::ordered_json manifest(const simulation& run, const session_record& session);

}  // namespace apsis
