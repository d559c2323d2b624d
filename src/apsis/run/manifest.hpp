#pragma once

#include <apsis/run/records.hpp>

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace apsis {

/// How a run ended.
enum class run_end {
  complete,     ///< at time.end
  interrupted,  ///< stopped with a checkpoint, as session_options::stop asked
  wall_time,    ///< likewise, because session_options::wall was over
  failed        ///< with a numerical failure or a broken promise
};

/// As the manifest says it: "complete", "interrupted", "wall time reached", "failed".
std::string to_string(run_end end);

/// The object that `apsis run --json` prints.
nlohmann::ordered_json to_json(const simulation& run, const run_records& records);

/// What a manifest says of a session.
struct session_record {
  run_end end = run_end::complete;     ///< how it ended
  std::string message;                 ///< error of a failed run
  std::string started;                 ///< time_stamp() of its beginning
  std::vector<std::string> command;    ///< command line; empty where there is none
  std::optional<std::string> restart;  ///< checkpoint that it went on from, as it was given
};

/// manifest.json: the case as resolved, version, commit, command line, times, numbers of the run, build,
/// machine and host.
nlohmann::ordered_json manifest(const simulation& run, const session_record& session);

}  // namespace apsis
