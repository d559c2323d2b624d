#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

namespace apsis {

/// Compiler, build type, instruction set and libraries.
nlohmann::ordered_json build_info();

/// Processor, cores and threads in use.
nlohmann::ordered_json machine_info();

/// The present second in universal time, "2026-01-31T12:00:00Z".
std::string time_stamp();

}  // namespace apsis
