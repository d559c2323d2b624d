#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace apsis {

/// Returns compiler, build type, instruction set and library versions.
nlohmann::ordered_json build_info();

/// Returns processor model, number of cores and threads in use.
nlohmann::ordered_json machine_info();

/// Returns the host name; "unknown" if the system has none.
std::string host_name();

/// Returns the command line of this process, program name first; empty on systems without /proc.
std::vector<std::string> command_line();

/// Returns the current time in UTC, "2026-01-31T12:00:00Z".
std::string time_stamp();

}  // namespace apsis
