#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace apsis {

/// Compiler, build type, instruction set and libraries.
nlohmann::ordered_json build_info();

/// Processor, cores and threads in use.
nlohmann::ordered_json machine_info();

/// Name of this machine in its network; "unknown" where the system has none.
std::string host_name();

/// The arguments that this process was started with, the name of the program first; empty where the system
/// does not say (no /proc).
std::vector<std::string> command_line();

/// The present second in universal time, "2026-01-31T12:00:00Z".
std::string time_stamp();

}  // namespace apsis
