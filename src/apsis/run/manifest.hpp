#pragma once

#include <apsis/run/records.hpp>

#include <string>

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

/// manifest.json: the case as resolved, how it ended, numbers of the run, build and machine. `message` is the
/// error of a failed run.
nlohmann::ordered_json manifest(const simulation& run, run_end end, const std::string& message);

}  // namespace apsis
